// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/FirstRankWork.h"

#include <utility>

namespace volumic
{
namespace
{
/** Several times a second; a word to all ranks takes less than a millisecond. */
constexpr std::chrono::milliseconds Interval(100);

/** What rank 0 has to say to those that wait. */
enum class Word
{
  Progress, ///< How far it is, follows.
  Help      ///< There is work for all.
};
}

FirstRankWork::FirstRankWork(Communicator& ranks, Show show)
  : Ranks(ranks), ShowHere(std::move(show))
{
}

void FirstRankWork::Run(
  const std::function<void()>& work, const std::function<void()>& help)
{
  if (this->Ranks.Rank() != 0)
  {
    this->Wait(help);
    return;
  }
  this->OthersWait = this->Ranks.NumberOfRanks() > 1;
  this->Told = Clock::now();
  try
  {
    work();
  }
  catch (...)
  {
    this->OthersWait = false;
    throw;
  }
  if (std::exchange(this->OthersWait, false))
  {
    this->Ranks.Broadcast({}); // The end.
  }
}

void FirstRankWork::OnAllRanks(const std::function<void()>& work)
{
  const bool othersWait = std::exchange(this->OthersWait, false);
  if (othersWait)
  {
    MessageWriter writer;
    writer.Add(Word::Help);
    this->Ranks.Broadcast(writer.Take());
  }
  work();
  this->OthersWait = othersWait;
  this->Told = Clock::now();
}

bool FirstRankWork::GoOn(double share, const std::string& text)
{
  const bool goesOn = this->ShowHere(share, text);
  if (this->OthersWait && Clock::now() - this->Told > Interval)
  {
    this->IsStopped = this->Tell(share, text) || this->IsStopped;
    this->Told = Clock::now();
  }
  return goesOn && !this->IsStopped;
}

bool FirstRankWork::Tell(double share, const std::string& text)
{
  MessageWriter writer;
  writer.Add(Word::Progress);
  writer.Add(share);
  writer.AddArray(text);
  this->Ranks.Broadcast(writer.Take());
  return this->Ranks.IsAny(false);
}

void FirstRankWork::Wait(const std::function<void()>& help)
{
  for (;;)
  {
    const Message message = this->Ranks.Broadcast({});
    if (message.empty())
    {
      return;
    }
    MessageReader reader(message);
    if (reader.Take<Word>() == Word::Help)
    {
      help();
      continue;
    }
    const double share = reader.Take<double>();
    std::string text;
    reader.TakeArray(text);
    this->Ranks.IsAny(!this->ShowHere(share, text));
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Communicator.h"

#include <algorithm>
#include <new>
#include <utility>

namespace volumic
{
namespace
{
/** Bytes that go at once: MPI counts them in an int, and who drops them needs a place for them. */
constexpr std::size_t MostBytes = std::size_t(1) << 18;
}

void Communicator::SendHeader(int to, Kind kind, std::size_t bytes)
{
  Header header;
  header.Bytes = bytes;
  header.Is = kind;
  header.From = this->Rank();
  this->Send(to, &header, sizeof(header));
}

void Communicator::SendMessage(int to, const Message& message)
{
  this->SendHeader(to, Content, message.size());
  for (std::size_t begin = 0; begin < message.size(); begin += MostBytes)
  {
    this->Send(to, message.data() + begin, std::min(MostBytes, message.size() - begin));
  }
}

Message Communicator::ReceiveMessage(int from)
{
  this->Dropped.resize(MostBytes); // While there is memory: it is for when there is none.
  Header header;
  this->Receive(from, &header, sizeof(header));
  Message message;
  try
  {
    message.resize(header.Bytes);
  }
  catch (const std::bad_alloc&)
  {
    this->Drop(from, header.Bytes); // What comes after it must be found.
    throw;
  }
  for (std::size_t begin = 0; begin < message.size(); begin += MostBytes)
  {
    this->Receive(from, message.data() + begin, std::min(MostBytes, message.size() - begin));
  }
  if (header.Is == Failure)
  {
    this->HasFailed.resize(static_cast<std::size_t>(this->NumberOfRanks()), 0);
    this->HasFailed[static_cast<std::size_t>(from)] = 1;
    throw OtherRankFailed(std::string(message.begin(), message.end()));
  }
  return message;
}

void Communicator::Drop(int from, unsigned long long count)
{
  this->Dropped.resize(MostBytes); // Nothing new, mostly.
  for (unsigned long long begin = 0; begin < count; begin += MostBytes)
  {
    this->Receive(from, this->Dropped.data(),
      static_cast<std::size_t>(std::min<unsigned long long>(MostBytes, count - begin)));
  }
}

std::vector<Message> Communicator::Exchange(
  std::vector<Message> messages, const std::vector<int>& partners)
{
  const int own = this->Rank();
  std::vector<int> others = partners;
  for (int rank = 0; partners.empty() && rank < this->NumberOfRanks(); ++rank)
  {
    others.push_back(rank);
  }
  std::sort(others.begin(), others.end());
  std::vector<Message> received(messages.size());
  // Of two ranks the lower one sends first; pairs in the order of their ranks: none waits in a ring.
  for (const int rank : others)
  {
    const auto place = static_cast<std::size_t>(rank);
    if (rank == own)
    {
      received[place] = std::move(messages[place]);
    }
    else if (own < rank)
    {
      this->SendMessage(rank, messages[place]);
      received[place] = this->ReceiveMessage(rank);
    }
    else
    {
      received[place] = this->ReceiveMessage(rank);
      this->SendMessage(rank, messages[place]);
    }
  }
  return received;
}

std::vector<Message> Communicator::Gather(Message message)
{
  std::vector<Message> messages;
  if (this->Rank() != 0)
  {
    this->SendMessage(0, message);
    return messages;
  }
  messages.push_back(std::move(message));
  for (int rank = 1; rank < this->NumberOfRanks(); ++rank)
  {
    messages.push_back(this->ReceiveMessage(rank));
  }
  return messages;
}

Message Communicator::Pass(int from, int to, Message message)
{
  if (from == to)
  {
    return message;
  }
  if (this->Rank() == from)
  {
    this->SendMessage(to, message);
  }
  return this->Rank() == to ? this->ReceiveMessage(from) : Message();
}

Message Communicator::Broadcast(Message message)
{
  if (this->Rank() != 0)
  {
    return this->ReceiveMessage(0);
  }
  for (int rank = 1; rank < this->NumberOfRanks(); ++rank)
  {
    this->SendMessage(rank, message);
  }
  return message;
}

std::vector<Message> Communicator::GatherOnAll(Message message)
{
  const std::vector<Message> gathered = this->Gather(std::move(message));
  MessageWriter all;
  for (const Message& of : gathered)
  {
    all.AddArray(of);
  }
  const Message content = this->Broadcast(all.Take());
  MessageReader reader(content);
  std::vector<Message> messages(static_cast<std::size_t>(this->NumberOfRanks()));
  for (Message& of : messages)
  {
    reader.TakeArray(of);
  }
  return messages;
}

bool Communicator::IsAny(bool isHere)
{
  if (this->NumberOfRanks() == 1)
  {
    return isHere;
  }
  const std::vector<char> all = GatherValues(*this, static_cast<char>(isHere));
  return std::find(all.begin(), all.end(), 1) != all.end();
}

void Communicator::EndRun(const Message& reason)
{
  const auto count = static_cast<std::size_t>(this->NumberOfRanks());
  const auto isOther = [this](int rank) { return rank != this->Rank(); };
  for (int rank = 0; rank < this->NumberOfRanks(); ++rank)
  {
    if (isOther(rank))
    {
      this->SendHeader(rank, Failure, reason.size());
      this->Send(rank, reason.data(), reason.size());
    }
  }
  // What others have sent before they heard of it is for nobody.
  this->HasFailed.resize(count, 0);
  this->HasFailed[static_cast<std::size_t>(this->Rank())] = 1;
  int done = 0;
  const auto lacks = [this] // Rank 0 waits for the others to be done as well.
  { return std::find(this->HasFailed.begin(), this->HasFailed.end(), 0) != this->HasFailed.end(); };
  while (lacks() || (this->Rank() == 0 && done + 1 < this->NumberOfRanks()))
  {
    Header header;
    this->ReceiveFromAny(&header, sizeof(header));
    this->Drop(header.From, header.Bytes);
    this->HasFailed[static_cast<std::size_t>(header.From)] |= header.Is == Failure;
    done += header.Is == Done;
  }
  // Nobody begins anew before all are here.
  if (this->Rank() != 0)
  {
    this->SendHeader(0, Done, 0);
    Header header;
    this->Receive(0, &header, sizeof(header));
    return;
  }
  for (int rank = 1; rank < this->NumberOfRanks(); ++rank)
  {
    this->SendHeader(rank, Done, 0);
  }
}

void Communicator::Fail(const std::string& reason) noexcept
{
  try
  {
    // Short enough to be taken by whoever is not waiting for it yet.
    constexpr std::size_t most = 1000;
    Message message(reason.begin(), reason.end());
    message.resize(std::clamp(message.size(), std::size_t(1), most), '?');
    this->EndRun(message);
  }
  catch (...)
  {
    // There is nobody left to tell.
  }
  this->HasFailed.clear();
}
}

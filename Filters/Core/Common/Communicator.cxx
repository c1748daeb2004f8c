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

/** In the tree: see the class. */
int RankAbove(int rank)
{
  return rank & (rank - 1);
}

std::vector<Message> Unpacked(const Message& packed)
{
  std::vector<Message> messages;
  for (MessageReader reader(packed); !reader.IsAtEnd();)
  {
    messages.push_back(reader.TakeVector<char>());
  }
  return messages;
}
}

std::vector<int> Communicator::RanksBelow() const
{
  // Below each of them are those up to the next, so that messages follow each other by rank.
  std::vector<int> below;
  const int own = this->Rank();
  for (int bit = 1; (own & bit) == 0 && own + bit < this->NumberOfRanks(); bit *= 2)
  {
    below.push_back(own + bit);
  }
  return below;
}

void Communicator::SendHeader(int to, Kind kind, std::size_t bytes)
{
  Header header;
  header.Bytes = bytes;
  header.Is = kind;
  header.From = this->Rank();
  this->Send(to, &header, sizeof(header));
  this->SentSoFar.Bytes += sizeof(header) + bytes;
  ++this->SentSoFar.Messages;
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

Message Communicator::GatherPacked(Message message)
{
  MessageWriter own;
  own.AddArray(message);
  message = own.Take();
  for (const int rank : this->RanksBelow())
  {
    const Message ofRank = this->ReceiveMessage(rank);
    message.insert(message.end(), ofRank.begin(), ofRank.end());
  }
  if (this->Rank() != 0)
  {
    this->SendMessage(RankAbove(this->Rank()), message);
    return {};
  }
  return message;
}

std::vector<Message> Communicator::Gather(Message message)
{
  const Message all = this->GatherPacked(std::move(message));
  return this->Rank() == 0 ? Unpacked(all) : std::vector<Message>();
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
    message = this->ReceiveMessage(RankAbove(this->Rank()));
  }
  const std::vector<int> below = this->RanksBelow();
  std::for_each(below.rbegin(), below.rend(), // The longest way first.
    [&](int rank) { this->SendMessage(rank, message); });
  return message;
}

std::vector<Message> Communicator::GatherOnAll(Message message)
{
  return Unpacked(this->Broadcast(this->GatherPacked(std::move(message))));
}

Message Communicator::Scatter(std::vector<Message> messages)
{
  if (this->Rank() != 0)
  {
    messages = Unpacked(this->ReceiveMessage(RankAbove(this->Rank())));
  }
  const std::vector<int> below = this->RanksBelow();
  for (auto rank = below.rbegin(); rank != below.rend(); ++rank)
  {
    MessageWriter ofRank;
    const auto first = messages.begin() + (*rank - this->Rank());
    std::for_each(first, messages.end(), [&](const Message& one) { ofRank.AddArray(one); });
    messages.erase(first, messages.end());
    this->SendMessage(*rank, ofRank.Take());
  }
  return std::move(messages.front());
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

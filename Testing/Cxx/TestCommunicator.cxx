// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ThreadRanks.h"

#include <atomic>

namespace
{
using namespace volumic;

Message Text(const std::string& text)
{
  return { text.begin(), text.end() };
}

std::string FromTo(int from, int to)
{
  return std::to_string(from) + " to " + std::to_string(to);
}

TEST(Communicator, BringsEachRankTheMessagesOfAllOthers)
{
  for (const int count : { 1, 2, 5 })
  {
    ThreadRanks::Run(count,
      [count](Communicator& ranks)
      {
        std::vector<Message> messages;
        for (int to = 0; to < count; ++to)
        {
          messages.push_back(Text(FromTo(ranks.Rank(), to)));
        }
        const std::vector<Message> received = ranks.Exchange(messages);
        ASSERT_EQ(received.size(), static_cast<std::size_t>(count));
        for (int from = 0; from < count; ++from)
        {
          EXPECT_EQ(received[static_cast<std::size_t>(from)], Text(FromTo(from, ranks.Rank())));
        }
      });
  }
}

TEST(Communicator, ExchangesWithPartnersOnly)
{
  ThreadRanks::Run(4,
    [](Communicator& ranks)
    {
      const int partner = ranks.Rank() ^ 1;
      std::vector<Message> messages(4, Text("for nobody"));
      messages[static_cast<std::size_t>(partner)] = Text(FromTo(ranks.Rank(), partner));
      const std::vector<Message> received = ranks.Exchange(messages, { partner });
      for (int from = 0; from < 4; ++from)
      {
        EXPECT_EQ(received[static_cast<std::size_t>(from)],
          from == partner ? Text(FromTo(from, ranks.Rank())) : Message());
      }
    });
}

TEST(Communicator, GathersBroadcastsAndScatters)
{
  for (int count = 1; count <= 13; ++count)
  {
    SCOPED_TRACE(count);
    ThreadRanks::Run(count,
      [count](Communicator& ranks)
      {
        const auto textOf = [](int rank) { return Message(static_cast<std::size_t>(rank), 'a'); };
        std::vector<Message> all; // Of different lengths, the first is empty.
        for (int rank = 0; rank < count; ++rank)
        {
          all.push_back(textOf(rank));
        }
        const bool isFirst = ranks.Rank() == 0;
        EXPECT_EQ(ranks.Gather(textOf(ranks.Rank())), isFirst ? all : std::vector<Message>());
        EXPECT_EQ(ranks.GatherOnAll(textOf(ranks.Rank())), all);
        EXPECT_EQ(BroadcastValue(ranks, 7 + ranks.Rank()), 7);
        EXPECT_EQ(ranks.Scatter(isFirst ? all : std::vector<Message>()), textOf(ranks.Rank()));
        EXPECT_TRUE(ranks.IsAny(ranks.Rank() == count - 1));
        EXPECT_FALSE(ranks.IsAny(false));
      });
  }
}

TEST(Communicator, CountsWhatARankSendsAndSendsItToFew)
{
  ThreadRanks::Run(1, [](Communicator& ranks)
    {
      ranks.GatherOnAll(Text("to nobody"));
      EXPECT_EQ(ranks.Sent().Messages, 0u);
      EXPECT_EQ(ranks.Sent().Bytes, 0u);
    });
  ThreadRanks::Run(16, [](Communicator& ranks)
    {
      const auto sentIn = [&](const std::function<void()>& call)
      {
        const Communicator::Traffic before = ranks.Sent();
        call();
        return Communicator::Traffic{ ranks.Sent().Bytes - before.Bytes,
          ranks.Sent().Messages - before.Messages };
      };
      const bool isFirst = ranks.Rank() == 0;
      EXPECT_LE(sentIn([&] { ranks.Broadcast(Message(10, 'x')); }).Messages, 4u);
      EXPECT_EQ(sentIn([&] { ranks.Gather(Message(10, 'x')); }).Messages, isFirst ? 0u : 1u);
      EXPECT_LE(sentIn([&] { ranks.GatherOnAll(Message(10, 'x')); }).Messages, 5u);
      const std::vector<Message> all(isFirst ? 16 : 0);
      EXPECT_LE(sentIn([&] { ranks.Scatter(all); }).Messages, 4u);
      const unsigned long long header = sentIn([&] { ranks.Pass(1, 0); }).Bytes;
      const unsigned long long one = sentIn([&] { ranks.Pass(1, 0, Message(1000000, 'x')); }).Bytes;
      EXPECT_EQ(one - header, ranks.Rank() == 1 ? 1000000u : 0u);
      EXPECT_EQ(header > 0, ranks.Rank() == 1);
    });
}

TEST(Communicator, TellsAllRanksOfAFailureWhereverTheyWait)
{
  for (int failing = 0; failing < 4; ++failing)
  {
    std::atomic<int> told{ 0 };
    const auto work = [&](Communicator& ranks)
    {
      if (ranks.Rank() == failing)
      {
        throw std::runtime_error("rank " + std::to_string(failing) + " is out of luck");
      }
      try
      {
        // Those with a lower rank have got further when they hear of it.
        ranks.Exchange(std::vector<Message>(4, Message(100000, 'x')));
        ranks.GatherOnAll(Text("on time"));
        FAIL() << "went on without rank " << failing;
      }
      catch (const OtherRankFailed& error)
      {
        EXPECT_EQ(error.what(), "rank " + std::to_string(failing) + " is out of luck");
        ++told;
        throw;
      }
    };
    EXPECT_THROW(ThreadRanks::Run(4, work), std::runtime_error);
    EXPECT_EQ(told, 3);
  }
}

TEST(Communicator, TellsOfAFailureInAnyCall)
{
  // One fails before some call; the others are in it, or in one after it. Long messages, of which
  // some are on the way then, are dropped; and the next run finds nothing of them.
  constexpr int count = 6;
  using Call = std::function<void(Communicator&)>;
  const Message text(300000, 'x');
  const std::vector<Call> calls = { [&](Communicator& ranks) { ranks.Broadcast(text); },
    [&](Communicator& ranks) { ranks.Gather(text); },
    [&](Communicator& ranks) { ranks.GatherOnAll(text); },
    [&](Communicator& ranks)
    { ranks.Scatter(std::vector<Message>(ranks.Rank() == 0 ? count : 0, text)); },
    [&](Communicator& ranks) { ranks.Exchange(std::vector<Message>(count, text)); } };
  ThreadRanks::Run(count,
    [&](Communicator& ranks)
    {
      for (std::size_t call = 0; call < calls.size(); ++call)
      {
        for (int failing = 0; failing < count; ++failing)
        {
          const std::string reason = "rank " + FromTo(failing, static_cast<int>(call));
          try
          {
            for (std::size_t i = 0; i < calls.size(); ++i)
            {
              if (i == call && ranks.Rank() == failing)
              {
                throw std::runtime_error(reason);
              }
              calls[i](ranks);
            }
            ranks.GatherOnAll({}); // Some have sent what they had to; nobody gets past this one.
            ADD_FAILURE() << "went on without " << reason;
          }
          catch (const std::runtime_error& error)
          {
            EXPECT_EQ(error.what(), reason);
            EXPECT_EQ(dynamic_cast<const OtherRankFailed*>(&error) == nullptr,
              ranks.Rank() == failing);
            ranks.Fail(error.what());
          }
          EXPECT_EQ(GatherValues(ranks, ranks.Rank()), (std::vector<int>{ 0, 1, 2, 3, 4, 5 }));
        }
      }
    });
}

TEST(Communicator, IsAsNewAfterAFailure)
{
  ThreadRanks::Run(3,
    [](Communicator& ranks)
    {
      for (int round = 0; round < 20; ++round)
      {
        if (ranks.Rank() == round % 3)
        {
          ranks.Fail("once more");
        }
        else
        {
          EXPECT_THROW(ranks.GatherOnAll(Message(1000, 'x')), OtherRankFailed);
          ranks.Fail("as told");
        }
        EXPECT_EQ(GatherValues(ranks, ranks.Rank()), (std::vector<int>{ 0, 1, 2 }));
      }
    });
}

TEST(Communicator, TakesAMessageApartAsItWasPutTogether)
{
  MessageWriter writer;
  writer.Add(3.5);
  writer.AddArray(std::vector<int>{ 1, 2, 3 });
  writer.AddArray(std::vector<int>{});
  writer.Add('c');
  const Message message = writer.Take();
  MessageReader reader(message);
  EXPECT_EQ(reader.Take<double>(), 3.5);
  EXPECT_EQ(reader.TakeVector<int>(), (std::vector<int>{ 1, 2, 3 }));
  EXPECT_TRUE(reader.TakeVector<int>().empty());
  EXPECT_FALSE(reader.IsAtEnd());
  EXPECT_EQ(reader.Take<char>(), 'c');
  EXPECT_TRUE(reader.IsAtEnd());
  EXPECT_THROW(reader.Take<char>(), std::logic_error);
}
}

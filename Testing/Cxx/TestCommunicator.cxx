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

TEST(Communicator, GathersAndBroadcasts)
{
  ThreadRanks::Run(3,
    [](Communicator& ranks)
    {
      EXPECT_EQ(GatherValues(ranks, 10 * ranks.Rank()), (std::vector<int>{ 0, 10, 20 }));
      EXPECT_EQ(BroadcastValue(ranks, 7 + ranks.Rank()), 7);
      EXPECT_EQ(ranks.Gather(Text("a")).size(), ranks.Rank() == 0 ? 3u : 0u);
      EXPECT_TRUE(ranks.IsAny(ranks.Rank() == 2));
      EXPECT_FALSE(ranks.IsAny(false));
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

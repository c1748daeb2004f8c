// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/BlockSchedule.h"
#include "ThreadTestTools.h"

#include <cstdlib>
#include <mutex>

using namespace volumic;

namespace
{
using Neighbours = std::vector<std::vector<int>>;

/** From 0 on. */
std::vector<int> InOrder(int n)
{
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/** Items that do not touch. */
BlockSchedule Apart(int n)
{
  return BlockSchedule(InOrder(n), [](int) { return std::vector<int>(); });
}

/** Each touches the one before it. */
BlockSchedule ChainOf(int n)
{
  return BlockSchedule(InOrder(n),
    [n](int item)
    {
      std::vector<int> touched;
      if (item > 0)
      {
        touched.push_back(item - 1);
      }
      if (item + 1 < n)
      {
        touched.push_back(item + 1);
      }
      return touched;
    });
}

bool Always(std::size_t)
{
  return true;
}

/** Cells of a box of this size: those that have a corner in common touch, but for some left out. */
Neighbours GridOf(const std::array<int, 3>& size, double share, std::mt19937& random)
{
  Neighbours neighbours(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::uniform_real_distribution<double> chance(0., 1.);
  const auto placeOf = [&size](int item)
  {
    const int row = item / size[0];
    return std::array<int, 3>{ item % size[0], row % size[1], row / size[1] };
  };
  for (int a = 0; a < static_cast<int>(neighbours.size()); ++a)
  {
    for (int b = a + 1; b < static_cast<int>(neighbours.size()); ++b)
    {
      const std::array<int, 3> p = placeOf(a);
      const std::array<int, 3> q = placeOf(b);
      if (std::abs(p[0] - q[0]) <= 1 && std::abs(p[1] - q[1]) <= 1 && std::abs(p[2] - q[2]) <= 1 &&
        chance(random) < share)
      {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
      }
    }
  }
  return neighbours;
}

std::vector<int> Shuffled(int n, std::mt19937& random)
{
  std::vector<int> order = InOrder(n);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

BlockSchedule ScheduleOf(const std::vector<int>& order, const Neighbours& neighbours)
{
  return BlockSchedule(order, [&neighbours](int item) { return neighbours[item]; });
}

/** Hears of visits from any thread, and whether each comes when it may. */
class Book
{
public:
  Book(const std::vector<int>& order, const Neighbours& neighbours)
    : Touching(neighbours), Place(order.size()), Begun(order.size(), 0), Ended(order.size(), 0)
  {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      this->Place[order[i]] = i;
    }
  }

  void Begin(int item)
  {
    const std::size_t place = this->Place[item];
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Check(++this->Begun[item] == 1, item, "visited again");
    for (const int other : this->Touching[item])
    {
      this->Check(this->Begun[other] == this->Ended[other], item, "at the same time");
      this->Check((this->Ended[other] == 1) == (this->Place[other] < place), item, "out of turn");
    }
    ++this->UnderWay;
    this->Most = std::max(this->Most, this->UnderWay);
  }
  void End(int item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    ++this->Ended[item];
    --this->UnderWay;
  }

  /** What was wrong first; empty: nothing. */
  std::string Wrong() const
  {
    const bool areAllVisited =
      std::all_of(this->Ended.begin(), this->Ended.end(), [](int visits) { return visits == 1; });
    return this->First.empty() && !areAllVisited ? "some were left out" : this->First;
  }
  int MostUnderWay() const { return this->Most; }

private:
  void Check(bool isRight, int item, const char* what)
  {
    if (!isRight && this->First.empty())
    {
      this->First = std::to_string(item) + ": " + what;
    }
  }

  const Neighbours& Touching;
  std::vector<std::size_t> Place;
  std::vector<int> Begun; ///< How often.
  std::vector<int> Ended;
  int UnderWay = 0;
  int Most = 0;
  std::string First;
  std::mutex Mutex;
};
}

TEST(BlockSchedule, VisitsEachOnceAndNeverWhatTouchesAtTheSameTime)
{
  std::mt19937 random(20);
  for (const int threads : { 1, 2, 5 })
  {
    Executor executor(threads);
    for (int grid = 0; grid < 12; ++grid)
    {
      SCOPED_TRACE(std::to_string(threads) + " threads, grid " + std::to_string(grid));
      const auto length = [&random] { return 1 + static_cast<int>(random() % 6); };
      const std::array<int, 3> size = { length(), length(), length() };
      const int n = size[0] * size[1] * size[2];
      const Neighbours neighbours = GridOf(size, grid % 3 == 0 ? 1. : 0.6, random);
      const std::vector<int> order = Shuffled(n, random);
      std::vector<int> delays(static_cast<std::size_t>(n));
      std::generate(
        delays.begin(), delays.end(), [&random] { return static_cast<int>(random() % 200); });
      Book book(order, neighbours);
      const bool areAllDone =
        ScheduleOf(order, neighbours)
          .Run(
            executor,
            [&](int item)
            {
              book.Begin(item);
              std::this_thread::sleep_for(std::chrono::microseconds(delays[item]));
              book.End(item);
            },
            Always);
      EXPECT_TRUE(areAllDone);
      EXPECT_EQ(book.Wrong(), "");
      EXPECT_LE(book.MostUnderWay(), threads);
    }
  }
}

TEST(BlockSchedule, MakesWhatOneThreadWouldMake)
{
  // What a visit makes depends on what those that it touches have made before.
  std::mt19937 random(4);
  const Neighbours neighbours = GridOf({ 7, 6, 5 }, 0.8, random);
  const std::vector<int> order = Shuffled(7 * 6 * 5, random);
  const BlockSchedule schedule = ScheduleOf(order, neighbours);
  const auto madeBy = [&](Executor& executor)
  {
    std::vector<std::uint64_t> values(order.size(), 1);
    schedule.Run(
      executor,
      [&](int item)
      {
        for (const int other : neighbours[item])
        {
          values[item] = values[item] * 6364136223846793005ull + values[other];
        }
      },
      Always);
    return values;
  };
  Executor thread;
  const std::vector<std::uint64_t> expected = madeBy(thread);
  for (const int threads : { 2, 3, 7 })
  {
    DelayedThreads executor(threads, 17u, 50, 4);
    for (int time = 0; time < 5; ++time)
    {
      EXPECT_EQ(madeBy(executor), expected) << threads << " threads";
    }
  }
}

TEST(BlockSchedule, KeepsTheOrderOnOneThread)
{
  std::mt19937 random(5);
  const Neighbours neighbours = GridOf({ 5, 4, 3 }, 0.7, random);
  const std::vector<int> order = Shuffled(60, random);
  Executor thread;
  std::vector<int> visited;
  EXPECT_TRUE(ScheduleOf(order, neighbours)
                .Run(
                  thread, [&visited](int item) { visited.push_back(item); }, Always));
  EXPECT_EQ(visited, order);
}

TEST(BlockSchedule, WaitsForNoMoreThanWhatItTouches)
{
  // The first one ends when all have been visited but the one that touches it.
  constexpr int n = 40;
  const BlockSchedule schedule(InOrder(n),
    [](int item)
    { return item == 0 ? std::vector<int>{ 1 } : std::vector<int>(item == 1 ? 1 : 0, 0); });
  Executor threads(2);
  std::atomic<int> others{ 0 };
  std::atomic<bool> isFree{ false };
  schedule.Run(
    threads,
    [&](int item)
    {
      others += item > 1;
      isFree = isFree || (item == 0 && HasReachedEnd([&] { return others == n - 2; }));
    },
    Always);
  EXPECT_TRUE(isFree);
  EXPECT_EQ(others, n - 2);
}

TEST(BlockSchedule, HandsOnWhatAVisitThrows)
{
  constexpr int n =
    5000; // More than can be made before others hear of it, on a machine however slow.
  const BlockSchedule chain = ChainOf(n);
  const BlockSchedule apart = Apart(n);
  Executor sequential;
  Executor three(3);
  Executor five(5);
  for (const BlockSchedule* schedule : { &chain, &apart })
  {
    for (Executor* executor : std::initializer_list<Executor*>{ &sequential, &three, &five })
    {
      for (const int bad : { 0, 20 })
      {
        std::atomic<int> begun{ 0 };
        std::atomic<int> underWay{ 0 };
        try
        {
          schedule->Run(
            *executor,
            [&](int item)
            {
              ++begun;
              ++underWay;
              std::this_thread::sleep_for(std::chrono::microseconds(500));
              --underWay;
              if (item == bad)
              {
                throw std::runtime_error("bad " + std::to_string(item));
              }
            },
            Always);
          FAIL() << "nothing is thrown";
        }
        catch (const std::runtime_error& error)
        {
          EXPECT_EQ(error.what(), "bad " + std::to_string(bad));
        }
        EXPECT_EQ(underWay, 0) << "it has left before others were finished";
        EXPECT_GT(begun, bad);
        EXPECT_LT(begun, n) << "others went on";
      }
    }
  }
}

TEST(BlockSchedule, IdleThreadsShareTheLoopsOfAVisit)
{
  Executor threads(3);
  std::set<std::thread::id> seen;
  std::mutex mutex;
  const auto count = [&]
  {
    const std::lock_guard<std::mutex> lock(mutex);
    seen.insert(std::this_thread::get_id());
    return seen.size();
  };
  ChainOf(3).Run(
    threads,
    [&](int)
    {
      threads.For(
        30, 1, [&](std::size_t, std::size_t) { HasReachedEnd([&] { return count() == 3; }); });
    },
    Always);
  EXPECT_EQ(seen.size(), 3u);
}

TEST(BlockSchedule, CompletesTheLoopsOfVisitsUnderWayWhenAnotherFails)
{
  Executor threads(3);
  std::atomic<bool> isInLoop{ false };
  std::atomic<int> done{ 0 };
  EXPECT_THROW(Apart(2).Run(
                 threads,
                 [&](int item)
                 {
                   if (item == 0)
                   {
                     HasReachedEnd([&] { return isInLoop.load(); });
                     throw std::runtime_error("bad");
                   }
                   threads.For(400, 1,
                     [&](std::size_t begin, std::size_t end)
                     {
                       isInLoop = true;
                       std::this_thread::sleep_for(std::chrono::microseconds(200));
                       done += static_cast<int>(end - begin);
                     });
                 },
                 Always),
    std::runtime_error);
  EXPECT_EQ(done, 400);
}

TEST(BlockSchedule, CancelsAfterTheVisitAtWhichItIsRequested)
{
  const BlockSchedule schedule = Apart(50);
  Executor thread;
  for (const std::size_t last : { 1, 7, 49 })
  {
    std::size_t visits = 0;
    std::vector<std::size_t> asked;
    EXPECT_FALSE(schedule.Run(
      thread, [&visits](int) { ++visits; },
      [&](std::size_t done)
      {
        asked.push_back(done);
        return done != last;
      }));
    EXPECT_EQ(visits, last);
    std::vector<std::size_t> each(last);
    std::iota(each.begin(), each.end(), std::size_t(1));
    EXPECT_EQ(asked, each) << "once after each visit, and not again";
  }
}

TEST(BlockSchedule, CancelsOnThreads)
{
  constexpr int n = 50000; // More than can be made before the request, on a machine however slow.
  Executor threads(4);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> visits{ 0 };
  std::atomic<int> underWay{ 0 };
  int asked = 0;
  EXPECT_FALSE(Apart(n).Run(
    threads,
    [&](int)
    {
      ++visits;
      ++underWay;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --underWay;
    },
    [&](std::size_t)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      return ++asked < 3;
    }));
  EXPECT_EQ(asked, 3) << "not asked again";
  EXPECT_EQ(underWay, 0);
  EXPECT_GE(visits, 3);
  EXPECT_LT(visits, n);
}

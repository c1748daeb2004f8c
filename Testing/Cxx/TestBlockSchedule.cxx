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

std::vector<int> InOrder(int n)
{
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/** Blocks without neighbours. */
BlockSchedule Independent(int n)
{
  return BlockSchedule(InOrder(n), [](int) { return std::vector<int>(); });
}

/** Blocks that are neighbours of the previous and the next one. */
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

/** Cells of a grid. Pairs with a common corner are neighbours with a probability. */
Neighbours GridOf(const std::array<int, 3>& size, double probability, std::mt19937& random)
{
  Neighbours neighbours(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  std::uniform_real_distribution<double> chance(0., 1.);
  const auto ijkOf = [&size](int item)
  {
    const int row = item / size[0];
    return std::array<int, 3>{ item % size[0], row % size[1], row / size[1] };
  };
  for (int a = 0; a < static_cast<int>(neighbours.size()); ++a)
  {
    for (int b = a + 1; b < static_cast<int>(neighbours.size()); ++b)
    {
      const std::array<int, 3> p = ijkOf(a);
      const std::array<int, 3> q = ijkOf(b);
      if (std::abs(p[0] - q[0]) <= 1 && std::abs(p[1] - q[1]) <= 1 && std::abs(p[2] - q[2]) <= 1 &&
        chance(random) < probability)
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

/** Records block passes from all threads and tests their order. */
class PassRecorder
{
public:
  PassRecorder(const std::vector<int>& order, const Neighbours& neighbours)
    : Adjacent(neighbours), Rank(order.size()), Begun(order.size(), 0), Ended(order.size(), 0)
  {
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      this->Rank[order[i]] = i;
    }
  }

  void Begin(int item)
  {
    const std::size_t rank = this->Rank[item];
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Check(++this->Begun[item] == 1, item, "repeated");
    for (const int other : this->Adjacent[item])
    {
      this->Check(this->Begun[other] == this->Ended[other], item, "concurrent with a neighbour");
      this->Check((this->Ended[other] == 1) == (this->Rank[other] < rank), item, "out of order");
    }
    ++this->Running;
    this->MostRunning = std::max(this->MostRunning, this->Running);
  }
  void End(int item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    ++this->Ended[item];
    --this->Running;
  }

  /** Return the first error; empty: none. */
  std::string Error() const
  {
    const bool areAllDone =
      std::all_of(this->Ended.begin(), this->Ended.end(), [](int passes) { return passes == 1; });
    return this->First.empty() && !areAllDone ? "incomplete" : this->First;
  }
  int MaximumConcurrency() const { return this->MostRunning; }

private:
  void Check(bool isValid, int item, const char* error)
  {
    if (!isValid && this->First.empty())
    {
      this->First = std::to_string(item) + ": " + error;
    }
  }

  const Neighbours& Adjacent;
  std::vector<std::size_t> Rank;
  std::vector<int> Begun; ///< number of passes
  std::vector<int> Ended;
  int Running = 0;
  int MostRunning = 0;
  std::string First;
  std::mutex Mutex;
};
}

TEST(BlockSchedule, RunsEachBlockOnceAndNeverWithNeighbours)
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
      PassRecorder recorder(order, neighbours);
      const bool areAllDone =
        ScheduleOf(order, neighbours)
          .Run(
            executor,
            [&](int item)
            {
              recorder.Begin(item);
              std::this_thread::sleep_for(std::chrono::microseconds(delays[item]));
              recorder.End(item);
            },
            Always);
      EXPECT_TRUE(areAllDone);
      EXPECT_EQ(recorder.Error(), "");
      EXPECT_LE(recorder.MaximumConcurrency(), threads);
    }
  }
}

TEST(BlockSchedule, IsIndependentOfThreadCount)
{
  // The result of a block depends on its neighbours.
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

TEST(BlockSchedule, PreservesOrderOnOneThread)
{
  std::mt19937 random(5);
  const Neighbours neighbours = GridOf({ 5, 4, 3 }, 0.7, random);
  const std::vector<int> order = Shuffled(60, random);
  Executor thread;
  std::vector<int> done;
  EXPECT_TRUE(ScheduleOf(order, neighbours)
                .Run(
                  thread, [&done](int item) { done.push_back(item); }, Always));
  EXPECT_EQ(done, order);
}

TEST(BlockSchedule, WaitsOnlyForNeighbours)
{
  // The first block waits for all except its neighbour.
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
      isFree = isFree || (item == 0 && WaitFor([&] { return others == n - 2; }));
    },
    Always);
  EXPECT_TRUE(isFree);
  EXPECT_EQ(others, n - 2);
}

TEST(BlockSchedule, RethrowsExceptions)
{
  constexpr int n = 5000; // more than are completed before the exception
  const BlockSchedule chain = ChainOf(n);
  const BlockSchedule independent = Independent(n);
  Executor sequential;
  Executor three(3);
  Executor five(5);
  for (const BlockSchedule* schedule : { &chain, &independent })
  {
    for (Executor* executor : std::initializer_list<Executor*>{ &sequential, &three, &five })
    {
      for (const int bad : { 0, 20 })
      {
        std::atomic<int> begun{ 0 };
        std::atomic<int> running{ 0 };
        try
        {
          schedule->Run(
            *executor,
            [&](int item)
            {
              ++begun;
              ++running;
              std::this_thread::sleep_for(std::chrono::microseconds(500));
              --running;
              if (item == bad)
              {
                throw std::runtime_error("bad " + std::to_string(item));
              }
            },
            Always);
          FAIL() << "no exception";
        }
        catch (const std::runtime_error& error)
        {
          EXPECT_EQ(error.what(), "bad " + std::to_string(bad));
        }
        EXPECT_EQ(running, 0) << "all threads have finished";
        EXPECT_GT(begun, bad);
        EXPECT_LT(begun, n) << "others stop";
      }
    }
  }
}

TEST(BlockSchedule, RunsNestedLoopsOnIdleThreads)
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
    [&](int) {
      threads.For(30, 1, [&](std::size_t, std::size_t) { WaitFor([&] { return count() == 3; }); });
    },
    Always);
  EXPECT_EQ(seen.size(), 3u);
}

TEST(BlockSchedule, CompletesNestedLoopsAfterException)
{
  Executor threads(3);
  std::atomic<bool> isInLoop{ false };
  std::atomic<int> done{ 0 };
  EXPECT_THROW(Independent(2).Run(
                 threads,
                 [&](int item)
                 {
                   if (item == 0)
                   {
                     WaitFor([&] { return isInLoop.load(); });
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

TEST(BlockSchedule, CancelsAfterRequestedBlock)
{
  const BlockSchedule schedule = Independent(50);
  Executor thread;
  for (const std::size_t last : { 1, 7, 49 })
  {
    std::size_t passes = 0;
    std::vector<std::size_t> queries;
    EXPECT_FALSE(schedule.Run(
      thread, [&passes](int) { ++passes; },
      [&](std::size_t done)
      {
        queries.push_back(done);
        return done != last;
      }));
    EXPECT_EQ(passes, last);
    std::vector<std::size_t> each(last);
    std::iota(each.begin(), each.end(), std::size_t(1));
    EXPECT_EQ(queries, each) << "one query after each block";
  }
}

TEST(BlockSchedule, CancelsOnSeveralThreads)
{
  constexpr int n = 50000; // more than are completed before the request
  Executor threads(4);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> passes{ 0 };
  std::atomic<int> running{ 0 };
  int queries = 0;
  EXPECT_FALSE(Independent(n).Run(
    threads,
    [&](int)
    {
      ++passes;
      ++running;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --running;
    },
    [&](std::size_t)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      return ++queries < 3;
    }));
  EXPECT_EQ(queries, 3);
  EXPECT_EQ(running, 0);
  EXPECT_GE(passes, 3);
  EXPECT_LT(passes, n);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/BlockSchedule.h"
#include "Core/Image/VoxelNumbers.h"
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
  const VoxelNumbers numbers(size);
  Neighbours neighbours(static_cast<std::size_t>(numbers.Count()));
  std::uniform_real_distribution<double> chance(0., 1.);
  for (int a = 0; a < static_cast<int>(neighbours.size()); ++a)
  {
    for (int b = a + 1; b < static_cast<int>(neighbours.size()); ++b)
    {
      const std::array<int, 3> p = numbers.IjkOf(a);
      const std::array<int, 3> q = numbers.IjkOf(b);
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
  }
  void End(int item)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    ++this->Ended[item];
  }

  /** Return the first error; empty: none. */
  std::string Error() const
  {
    const bool areAllDone =
      std::all_of(this->Ended.begin(), this->Ended.end(), [](int passes) { return passes == 1; });
    return this->First.empty() && !areAllDone ? "incomplete" : this->First;
  }

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
      std::vector<int> order = InOrder(n);
      std::shuffle(order.begin(), order.end(), random);
      std::vector<int> delays(static_cast<std::size_t>(n));
      std::generate(
        delays.begin(), delays.end(), [&random] { return static_cast<int>(random() % 200); });
      PassRecorder recorder(order, neighbours);
      const BlockSchedule schedule(order, [&neighbours](int item) { return neighbours[item]; });
      const auto process = [&](int item)
      {
        recorder.Begin(item);
        std::this_thread::sleep_for(std::chrono::microseconds(delays[item]));
        recorder.End(item);
      };
      EXPECT_TRUE(schedule.Run(executor, process, Always));
      EXPECT_EQ(recorder.Error(), "");
    }
  }
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
  for (const BlockSchedule& schedule : { ChainOf(n), Independent(n) })
  {
    for (const int threads : { 1, 3, 5 })
    {
      Executor executor(threads);
      std::atomic<int> begun{ 0 };
      std::atomic<int> running{ 0 };
      const auto process = [&](int item)
      {
        ++begun;
        ++running;
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        --running;
        if (item == 20)
        {
          throw std::out_of_range("bad");
        }
      };
      EXPECT_THROW(schedule.Run(executor, process, Always), std::out_of_range);
      EXPECT_EQ(running, 0) << "all threads have finished";
      EXPECT_GT(begun, 20);
      EXPECT_LT(begun, n) << "others stop";
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

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/CancellableExecutor.h"
#include "Core/Common/DisjointSets.h"
#include "Core/Common/Executor.h"
#include "Core/Common/FreeMemory.h"
#include "Core/Common/Lanes.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "TemporaryFolder.h"
#include "ThreadTestTools.h"

#include <fstream>
#include <mutex>
#include <new>
#include <unistd.h>

using namespace volumic;

namespace
{
constexpr std::size_t n = ScratchMemory::LargeBytes;

/** Whether the system maps an array to a file of a directory. */
bool IsIn(const TemporaryFolder& folder, const LargeVector<char>& array)
{
  const auto address = reinterpret_cast<std::uintptr_t>(array.data());
  const auto mapped = folder.Mapped();
  return std::any_of(mapped.begin(), mapped.end(),
    [address](const auto& range) { return range.first <= address && address < range.second; });
}
}

TEST(DisjointSets, AreIndependentOfThreadCount)
{
  constexpr int n = 3000;
  std::mt19937 random(7);
  Executor threads(4);
  for (int round = 0; round < 20; ++round)
  {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < n * (1 + round % 3) / 3; ++i)
    {
      pairs.emplace_back(static_cast<int>(random() % n), static_cast<int>(random() % n));
    }
    DisjointSets alone(n);
    for (const auto& pair : pairs)
    {
      alone.Join(pair.first, pair.second);
    }
    for (const auto& pair : pairs)
    {
      ASSERT_EQ(alone.Find(pair.first), alone.Find(pair.second));
    }
    DisjointSets shared(n);
    threads.For(pairs.size(), 1,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          shared.Join(pairs[i].first, pairs[i].second);
        }
      });
    for (int i = 0; i < n; ++i)
    {
      ASSERT_EQ(shared.Find(i), alone.Find(i));
      ASSERT_LE(alone.Find(i), i) << "the root is the smallest member";
    }
  }
}

TEST(Lanes, EqualScalarArithmetic)
{
  const auto laneOf = [](const Lanes& lanes, int i)
  {
    float four[Lanes::Count];
    lanes.Store(four);
    return four[i];
  };
  std::mt19937 random(1);
  const auto next = [&random] { return static_cast<float>(random() >> 8) / (1 << 23) - 1.f; };
  for (int round = 0; round < 100; ++round)
  {
    float a[4], b[4];
    for (int i = 0; i < 4; ++i)
    {
      a[i] = next();
      b[i] = i == round % 7 ? a[i] : next();
    }
    const Lanes x = Lanes::Load(a);
    const Lanes y = Lanes::Load(b);
    const unsigned less = LessBits(x, y);
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(laneOf(x + y, i), a[i] + b[i]);
      EXPECT_EQ(laneOf(x - y, i), a[i] - b[i]);
      EXPECT_EQ(laneOf(x * y, i), a[i] * b[i]);
      EXPECT_EQ(laneOf(x / y, i), a[i] / b[i]);
      EXPECT_EQ(laneOf(Minimum(x, y), i), std::min(a[i], b[i]));
      EXPECT_EQ(laneOf(Maximum(x, y), i), std::max(a[i], b[i]));
      EXPECT_EQ(laneOf(SquareRoot(x * x), i), std::sqrt(a[i] * a[i]));
      EXPECT_EQ(laneOf(WhereLess(x, y, x), i), a[i] < b[i] ? a[i] : 0.f);
      EXPECT_EQ(less >> i & 1, a[i] < b[i] ? 1u : 0u);
    }
    EXPECT_EQ(LeastOf(x), *std::min_element(a, a + 4));
    EXPECT_EQ(GreatestOf(x), *std::max_element(a, a + 4));
  }
}

TEST(VoxelNumbers, InvertIndices)
{
  for (const std::array<int, 3>& size : { std::array<int, 3>{ 1300, 1300, 1300 },
         { 2048, 2048, 2048 }, { 3, 5, 7 }, { 65536, 65536, 2 }, { 1, 1, 70000 } })
  {
    const VoxelNumbers numbers(size);
    EXPECT_EQ(numbers.Of(0, 0, 0), 0);
    const std::array<int, 3> last = { size[0] - 1, size[1] - 1, size[2] - 1 };
    EXPECT_EQ(numbers.Of(last[0], last[1], last[2]), numbers.Count() - 1);
    const std::array<int, 3> middle = { size[0] / 2, size[1] / 3, last[2] };
    for (const std::array<int, 3>& ijk : { last, middle })
    {
      EXPECT_EQ(numbers.IjkOf(numbers.Of(ijk[0], ijk[1], ijk[2])), ijk);
    }
  }
}

namespace
{
/** Return the resident memory of this process in MB; 0 if unknown. */
double ResidentMegabytes()
{
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}
}

TEST(FreeMemory, IsReleasedBelowBlockInUse)
{
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "another allocator";
#endif
  // 64 MB in blocks too small to be released one by one.
  constexpr std::size_t size = 16 * 1024;
  std::vector<std::vector<char>> blocks(4096);
  for (std::vector<char>& block : blocks)
  {
    block.assign(size, 'x');
  }
  const std::vector<char> last(size, 'x');
  const double before = ResidentMegabytes();
  ASSERT_GT(before, 64.) << "the resident memory is unknown";
  blocks.clear();
  GiveBackFreeMemory();
  EXPECT_LT(ResidentMegabytes(), before - 50.);
  EXPECT_EQ(last.back(), 'x');
}

TEST(Executor, CoversEachItemOnce)
{
  Executor threads(4);
  ASSERT_EQ(threads.NumberOfThreads(), 4);
  for (const std::size_t n : { 0, 1, 3, 100, 12345 })
  {
    for (const std::size_t grain : { 1, 7, 20000 })
    {
      std::vector<std::atomic<int>> done(n);
      threads.For(n, grain,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            ++done[i];
          }
        });
      for (std::size_t i = 0; i < n; ++i)
      {
        ASSERT_EQ(done[i], 1) << i << " of " << n << ", grain " << grain;
      }
    }
  }
}

TEST(Executor, UsesRequestedNumberOfThreads)
{
  for (const std::size_t number : { 1, 3 })
  {
    Executor threads(static_cast<int>(number));
    std::mutex mutex;
    std::set<std::thread::id> seen;
    const auto count = [&]
    {
      const std::lock_guard<std::mutex> lock(mutex);
      seen.insert(std::this_thread::get_id());
      return seen.size();
    };
    // The first items wait for all threads.
    threads.For(
      300, 1, [&](std::size_t, std::size_t) { WaitFor([&] { return count() >= number; }); });
    EXPECT_EQ(seen.size(), number);
  }
}

TEST(Executor, RethrowsExceptionsAndContinues)
{
  Executor threads(3);
  for (const std::size_t bad : { 0, 50, 99 })
  {
    const auto body = [bad](std::size_t begin, std::size_t end)
    {
      if (begin <= bad && bad < end)
      {
        throw std::out_of_range("bad");
      }
    };
    EXPECT_THROW(threads.For(100, 1, body), std::out_of_range);
  }
  const auto everywhere = [](std::size_t, std::size_t) { throw std::bad_alloc(); };
  EXPECT_THROW(threads.For(100, 1, everywhere), std::bad_alloc);
  std::atomic<int> done{ 0 };
  threads.For(100, 1, [&](std::size_t begin, std::size_t end) { done += int(end - begin); });
  EXPECT_EQ(done, 100);
}

TEST(CancellableExecutor, CancelsOnTheCallingThread)
{
  for (const int number : { 1, 3 })
  {
    Executor threads(number);
    const std::thread::id caller = std::this_thread::get_id();
    int queries = 0;
    CancellableExecutor cancellable(threads,
      [&]
      {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        return ++queries < 3;
      });
    constexpr int n = 100000; // more than a test can complete
    std::atomic<int> done{ 0 };
    const auto body = [&](std::size_t begin, std::size_t end)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      done += int(end - begin);
    };
    EXPECT_THROW(cancellable.For(n, 1, body), OperationCancelled);
    EXPECT_EQ(queries, 3);
    EXPECT_GE(done, 3);
    EXPECT_LT(done, n);
  }
}

TEST(ScratchMemory, StoresLargeArraysInUnnamedFiles)
{
  const TemporaryFolder folder;
  const TemporaryFolder other;
  const LargeVector<char> before(n, 'b');
  LargeVector<char> large;
  {
    const ScratchMemory scratch(folder.Path());
    LargeVector<char> small(n - 1);
    MakeZeroed(large, n + 1);
    EXPECT_FALSE(IsIn(folder, small));
    EXPECT_TRUE(IsIn(folder, large));
    EXPECT_EQ(std::count(large.begin(), large.end(), 0), static_cast<std::ptrdiff_t>(n + 1));
    large.back() = 'x';
    {
      const ScratchMemory last(other.Path());
      EXPECT_TRUE(IsIn(other, LargeVector<char>(n)));
      EXPECT_FALSE(IsIn(folder, before));
    }
    EXPECT_TRUE(IsIn(folder, LargeVector<char>(n)));
    EXPECT_TRUE(folder.Names().empty() && other.Names().empty());
  }
  EXPECT_TRUE(IsIn(folder, large)) << "arrays outlive the object";
  EXPECT_EQ(large.back(), 'x');
  const LargeVector<char> copy = large;
  EXPECT_FALSE(IsIn(folder, copy));
  EXPECT_EQ(copy, large);
}

TEST(ScratchMemory, ReservesDiskSpace)
{
  const TemporaryFolder folder;
  const ScratchMemory scratch(folder.Path());
  const std::size_t before = std::filesystem::space(folder.Path()).available;
  const auto allocate = [](std::size_t bytes) -> std::string
  {
    try
    {
      FreeLarge(AllocateLarge(bytes), bytes);
    }
    catch (const ScratchFull& full)
    {
      return full.what();
    }
    return "";
  };
  EXPECT_TRUE(Has(allocate(before + before / 2), "Scratch Directory " + folder.Path() + " lacks"));
  EXPECT_TRUE(Has(allocate(before + before / 2), "Free space there, or choose another"));
  EXPECT_GT(std::filesystem::space(folder.Path()).available, before / 2);
  const LimitedFileSize limit(2 * n);
  EXPECT_TRUE(Has(allocate(3 * n), "Allow larger files (ulimit -f)"));
  EXPECT_EQ(allocate(2 * n), "");
}

TEST(ScratchMemory, ReservesCapacity)
{
  LargeVector<Vector> values;
  MakeRoom(values, n);
  values.resize(n);
  const Vector* const data = values.data();
  values[n - 1].X = 1.f;
  values.resize(2 * n);
  EXPECT_EQ(values.data(), data);
  MakeRoom(values, 3 * n);
  EXPECT_EQ(values.size(), 2 * n) << "the capacity suffices";
  EXPECT_EQ(values[n - 1].X, 1.f);
  MakeRoom(values, 3 * n + 1);
  EXPECT_TRUE(values.empty());
}

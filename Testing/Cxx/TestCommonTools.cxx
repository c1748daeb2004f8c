// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Executor.h"
#include "Core/Common/FreeMemory.h"
#include "Core/Common/Lanes.h"
#include "Core/Image/VoxelNumbers.h"
#include "TestPrelude.h"

#include <fstream>
#include <unistd.h>

using namespace volumic;

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
    float a[4];
    float b[4];
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
  long all = 0;
  long resident = 0;
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

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/AxisOperator.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "ForVoxels.h"
#include "ThreadTestTools.h"

#include <cstring>
#include <type_traits>

using namespace volumic;

namespace
{
const LevelProgress GoOn = [](double) { return true; };

template <typename T>
std::vector<T> RandomVoxels(std::int64_t n)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<T> voxels(n);
  for (T& voxel : voxels)
  {
    voxel = static_cast<T>(share(generator) * 120.0);
  }
  return voxels;
}

template <typename T>
std::vector<typename RealOf<T>::Type> Reduce(
  const std::vector<T>& voxels, const std::vector<LevelGeometry>& levels, Executor& executor)
{
  std::vector<typename RealOf<T>::Type> out(levels[1].NumberOfVoxels(), -1);
  EXPECT_TRUE(ReduceLevel(voxels.data(), levels[0], out.data(), levels[1], executor, GoOn));
  return out;
}

std::vector<LevelGeometry> TwoLevels(
  const LevelSize& size, const std::array<double, 3>& spacing = { 1, 1, 1 })
{
  PyramidOptions options;
  options.NumberOfLevels = 2;
  return PlanPyramid(size, spacing, options);
}
}

TEST(LevelReduction, IsTheSameBitsForAnyChunks)
{
  // Long enough along y for several tiles; sizes that no vector length divides.
  const auto levels = TwoLevels({ 61, 203, 23 }, { 1, 1, 2.5 });
  const auto voxels = RandomVoxels<float>(levels[0].NumberOfVoxels());
  Executor sequential;
  const auto expected = Reduce(voxels, levels, sequential);
  for (const std::size_t chunk : { 1, 3, 7 })
  {
    ScrambledExecutor scrambled(chunk);
    const auto found = Reduce(voxels, levels, scrambled);
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size() * sizeof(expected[0])), 0)
      << "chunks of " << chunk;
  }
}

TEST(LevelReduction, IsTheProductOfTheOperatorsAlongTheAxes)
{
  // Voxels of three different lengths: the offset of the kernel is U_0 = 1 along each axis, which
  // is less than a voxel where voxels are longer.
  const auto levels = TwoLevels({ 13, 11, 9 }, { 1, 1.3, 2.5 });
  const auto voxels = RandomVoxels<double>(levels[0].NumberOfVoxels());
  Executor executor;
  const auto found = Reduce(voxels, levels, executor);
  const LevelSize& in = levels[0].Size;
  const LevelSize& out = levels[1].Size;
  const AxisOperator x(in[0], out[0], 1.);
  const AxisOperator y(in[1], out[1], 1. / 1.3);
  const AxisOperator z(in[2], out[2], 1. / 2.5);
  for (std::int64_t i = 0; i < levels[1].NumberOfVoxels(); ++i)
  {
    const std::int64_t place[3] = { i % out[0], i / out[0] % out[1], i / out[0] / out[1] };
    double sum = 0;
    ForVoxels({ x.NumberOfTaps(), y.NumberOfTaps(), z.NumberOfTaps() },
      [&](int a, int b, int c)
      {
        const std::int64_t voxel = x.First(place[0]) + a +
          in[0] * (y.First(place[1]) + b + in[1] * (z.First(place[2]) + c));
        sum += x.Weights(place[0])[a] * y.Weights(place[1])[b] * z.Weights(place[2])[c] *
          voxels[voxel];
      });
    EXPECT_NEAR(found[i], sum, 1e-10) << "voxel " << i;
  }
}

template <typename T>
class LevelReductionOf : public ::testing::Test
{
};
using Scalars = ::testing::Types<char, signed char, unsigned char, short, unsigned short, int,
  unsigned int, long, unsigned long, long long, unsigned long long, float, double>;
TYPED_TEST_SUITE(LevelReductionOf, Scalars, ); // C++17 wants the comma

TYPED_TEST(LevelReductionOf, GivesWhatDoublesGiveWhateverAVectorLengthLeaves)
{
  using Real = typename RealOf<TypeParam>::Type;
  const bool isDouble = std::is_same<TypeParam, double>::value;
  EXPECT_EQ((std::is_same<Real, double>::value), isDouble);
  Executor executor;
  for (std::int64_t width = 1; width <= 40; ++width)
  {
    const auto levels = TwoLevels({ width, 11, 5 }, { 1, 1.3, 2.5 });
    const auto voxels = RandomVoxels<TypeParam>(levels[0].NumberOfVoxels());
    const auto found = Reduce(voxels, levels, executor);
    const auto expected =
      Reduce(std::vector<double>(voxels.begin(), voxels.end()), levels, executor);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      ASSERT_NEAR(found[i], expected[i], isDouble ? 0.0 : 1e-4)
        << "width " << width << ", voxel " << i;
    }
  }
}

TEST(LevelReduction, StopsWhenAsked)
{
  // Large enough for several reports: one per few million voxels.
  const auto levels = TwoLevels({ 256, 256, 200 });
  const std::vector<unsigned char> voxels(levels[0].NumberOfVoxels(), 1);
  std::vector<float> out(levels[1].NumberOfVoxels(), -1.f);
  Executor executor;
  int reports = 0;
  const auto stop = [&](double share)
  {
    EXPECT_LT(share, 1.0);
    ++reports;
    return false;
  };
  EXPECT_FALSE(ReduceLevel(voxels.data(), levels[0], out.data(), levels[1], executor, stop));
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(out.back(), -1.f) << "the rest is not computed after a stop";
}

TEST(FindNotFiniteVoxels, CountsAndFindsTheFirst)
{
  std::vector<float> voxels(300000, 1.f);
  Executor executor;
  EXPECT_EQ(FindNotFiniteVoxels(voxels.data(), 300000, executor).Count, 0);
  EXPECT_EQ(FindNotFiniteVoxels(voxels.data(), 300000, executor).First, -1);
  voxels[299999] = std::numeric_limits<float>::quiet_NaN();
  voxels[70001] = -std::numeric_limits<float>::infinity();
  voxels[70007] = std::numeric_limits<float>::infinity();
  ScrambledExecutor scrambled(2);
  for (Executor* e : { static_cast<Executor*>(&executor), static_cast<Executor*>(&scrambled) })
  {
    const NotFiniteVoxels found = FindNotFiniteVoxels(voxels.data(), 300000, *e);
    EXPECT_EQ(found.Count, 3);
    EXPECT_EQ(found.First, 70001);
  }
}

TEST(ValidReduction, IsTheMeanOfTheVoxelsWithAValue)
{
  const auto levels = TwoLevels({ 30, 20, 24 });
  Executor executor;
  // Some have none: the mean of the others is theirs, whatever stands at these places.
  LargeVector<std::uint8_t> valid(levels[0].NumberOfVoxels());
  std::vector<short> voxels(valid.size());
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    valid[i] = i % 7 == 0 ? 0 : 1;
    voxels[i] = i % 7 == 0 ? -9999 : 40;
  }
  std::vector<float> out(levels[1].NumberOfVoxels());
  std::vector<double> shares;
  EXPECT_TRUE(ReduceValidVoxels(voxels.data(), valid, levels[0], out.data(), levels[1], executor,
    [&](double share)
    {
      shares.push_back(share);
      return true;
    }));
  for (const float value : out)
  {
    ASSERT_NEAR(value, 40.f, 1e-4f);
  }
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_EQ(MarkNumbers(out.data(), 3), LargeVector<std::uint8_t>(3, 1));
}

TEST(ValidReduction, HasNoValueWhereHalfOfTheWeightHasNone)
{
  const auto levels = TwoLevels({ 30, 20, 24 });
  Executor executor;
  LargeVector<std::uint8_t> valid(levels[0].NumberOfVoxels());
  for (std::size_t i = 0; i < valid.size(); ++i)
  {
    valid[i] = i % 30 < 15 ? 1 : 0;
  }
  const std::vector<double> voxels(valid.size(), 1e9 + 7.0);
  std::vector<double> out(levels[1].NumberOfVoxels());
  EXPECT_TRUE(ReduceValidVoxels(
    voxels.data(), valid, levels[0], out.data(), levels[1], executor, GoOn));
  const auto size = levels[1].Size;
  for (std::int64_t i = 0; i < levels[1].NumberOfVoxels(); ++i)
  {
    // Voxels of level 0 end at 14; half of the kernel lies beyond 14.5.
    const double place = static_cast<double>(i % size[0]) * 30.0 / static_cast<double>(size[0]);
    ASSERT_EQ(std::isnan(out[i]), place > 14.5) << place;
    ASSERT_TRUE(std::isnan(out[i]) || std::abs(out[i] - 1e9 - 7.0) < 1e-5);
  }
  EXPECT_EQ(MarkNumbers(out.data(), 1)[0], 1);
  EXPECT_EQ(MarkNumbers(&out[size[0] - 1], 1)[0], 0);
}

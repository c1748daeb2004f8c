// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "TestPrelude.h"

#include <type_traits>

using namespace volumic;

namespace
{
const ProgressCallback Continue = [](double) { return true; };

template <typename T>
std::vector<T> RandomVoxels(std::int64_t n)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<T> voxels(n);
  for (T& voxel : voxels)
  {
    voxel = static_cast<T>(uniform(generator) * 120.0);
  }
  return voxels;
}

template <typename T>
std::vector<typename RealOf<T>::Type> Reduce(
  const std::vector<T>& voxels, const std::vector<LevelGeometry>& levels, Executor& executor)
{
  std::vector<typename RealOf<T>::Type> out(levels[1].NumberOfVoxels(), -1);
  EXPECT_TRUE(ReduceLevel(voxels.data(), levels[0], out.data(), levels[1], executor, Continue));
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

template <typename T>
class LevelReductionOf : public ::testing::Test
{
};
using Scalars = ::testing::Types<char, signed char, unsigned char, short, unsigned short, int,
  unsigned int, long, unsigned long, long long, unsigned long long, float, double>;
TYPED_TEST_SUITE(LevelReductionOf, Scalars, ); // C++17 requires the last comma

TYPED_TEST(LevelReductionOf, AgreesWithDoubleForAnyWidth)
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

TEST(ValidReduction, IsNanWhereHalfOfWeightIsInvalid)
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
  EXPECT_TRUE(
    ReduceValidVoxels(voxels.data(), valid, levels[0], out.data(), levels[1], executor, Continue));
  const auto size = levels[1].Size;
  for (std::int64_t i = 0; i < levels[1].NumberOfVoxels(); ++i)
  {
    // Voxels are valid up to 14. At 14.5 half of the kernel is invalid.
    const double x = static_cast<double>(i % size[0]) * 30.0 / static_cast<double>(size[0]);
    ASSERT_EQ(std::isnan(out[i]), x > 14.5) << x;
    ASSERT_TRUE(std::isnan(out[i]) || std::abs(out[i] - 1e9 - 7.0) < 1e-5);
  }
  EXPECT_EQ(MarkNumbers(out.data(), 1)[0], 1);
  EXPECT_EQ(MarkNumbers(&out[size[0] - 1], 1)[0], 0);
}

TEST(PyramidGeometry, SizesFollowEquation4)
{
  const auto levels = PlanPyramid({ 256, 256, 68 }, { 1, 1, 1.0625 }, {});
  ASSERT_EQ(levels.size(), 4u) << "68, 39, 22, 12; 6 is below MinimumLevelSize";
  EXPECT_EQ(levels[0].Size, (LevelSize{ 256, 256, 68 }));
  EXPECT_EQ(levels[1].Size, (LevelSize{ 147, 147, 39 }));
  EXPECT_EQ(levels[2].Size, (LevelSize{ 84, 84, 22 }));
  EXPECT_EQ(levels[3].Size, (LevelSize{ 48, 48, 12 }));
  PyramidOptions options;
  options.MinimumLevelSize = 22;
  EXPECT_EQ(PlanPyramid({ 256, 256, 68 }, { 1, 1, 1 }, options).size(), 3u);
  options.MinimumLevelSize = 23;
  EXPECT_EQ(PlanPyramid({ 256, 256, 68 }, { 1, 1, 1 }, options).size(), 2u);
}

TEST(PyramidGeometry, SupportsSizesBeyond32Bits)
{
  const auto levels = PlanPyramid({ 2000000, 3000, 4000 }, { 1, 1, 1 }, {});
  EXPECT_EQ(levels[0].NumberOfVoxels(), 24000000000000LL);
  EXPECT_EQ(levels[1].Size[0], 1154700);
  EXPECT_EQ(levels[1].NumberOfVoxels(), 1154700LL * 1732 * 2309);
}

TEST(PyramidGeometry, RejectsInvalidOptions)
{
  struct Case
  {
    const char* Message; ///< empty: valid
    PyramidOptions Options;
    LevelSize Size = { 64, 64, 64 };
    std::array<double, 3> Spacing = { 1, 1, 1 };
  };
  const auto with = [](double factor, int levels = 0, int minimum = 10)
  {
    PyramidOptions options;
    options.ReductionFactor = factor;
    options.NumberOfLevels = levels;
    options.MinimumLevelSize = minimum;
    return options;
  };
  for (const Case& test :
    { Case{ "Reduction Factor is 1;", with(1.0) }, Case{ "Reduction Factor is 2;", with(2.0) },
      Case{ "Reduction Factor", with(std::nan("")) }, Case{ "", with(1.01) },
      Case{ "", with(1.99) }, Case{ "at most 7 levels", with(std::sqrt(3.0), 9) },
      Case{ "", with(std::sqrt(3.0), 7) }, Case{ "Number Of Levels is -1", with(1.5, -1) },
      Case{ "Minimum Level Size is 0", with(1.5, 0, 0) }, Case{ "empty", {}, { 0, 4, 4 } },
      Case{ "axis y", {}, { 4, 4, 4 }, { 1, 0, 1 } }, Case{ "", {}, { 4, 1, 4 }, { 1, 0, 1 } } })
  {
    const std::string error =
      ErrorMessageOf([&] { PlanPyramid(test.Size, test.Spacing, test.Options); });
    EXPECT_TRUE(Has(error, test.Message));
    EXPECT_EQ(error.empty(), std::string(test.Message).empty()) << error;
  }
}

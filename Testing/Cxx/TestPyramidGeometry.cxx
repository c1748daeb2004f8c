// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/PyramidGeometry.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
const double Sqrt3 = std::sqrt(3.0);

std::string ErrorOf(
  const LevelSize& size, const std::array<double, 3>& spacing, const PyramidOptions& options)
{
  return RefusalOf([&] { PlanPyramid(size, spacing, options); });
}

PyramidOptions WithFactor(double factor)
{
  PyramidOptions options;
  options.ReductionFactor = factor;
  return options;
}
}

TEST(PyramidGeometry, SizesFollowEquation4)
{
  const auto levels = PlanPyramid({ 256, 256, 68 }, { 1, 1, 1.0625 }, {});
  ASSERT_EQ(levels.size(), 4u) << "68 -> 39 -> 22 -> 12, and 6 would be under MinimumLevelSize";
  EXPECT_EQ(levels[0].Size, (LevelSize{ 256, 256, 68 }));
  EXPECT_EQ(levels[1].Size, (LevelSize{ 147, 147, 39 }));
  EXPECT_EQ(levels[2].Size, (LevelSize{ 84, 84, 22 }));
  EXPECT_EQ(levels[3].Size, (LevelSize{ 48, 48, 12 }));
}

TEST(PyramidGeometry, UnitsGrowByTheReductionFactor)
{
  const auto levels = PlanPyramid({ 100, 100, 100 }, { 0.5, 0.5, 2.0 }, {});
  for (std::size_t h = 0; h < levels.size(); ++h)
  {
    EXPECT_NEAR(levels[h].Unit, 0.5 * std::pow(Sqrt3, h), 1e-12) << "level " << h;
  }
}

TEST(PyramidGeometry, AllLevelsHaveTheRealSizeOfTheInput)
{
  const std::array<double, 3> spacing = { 0.5, -1.5, 2.0 };
  const auto levels = PlanPyramid({ 100, 61, 37 }, spacing, {});
  ASSERT_GT(levels.size(), 2u);
  for (const LevelGeometry& level : levels)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_DOUBLE_EQ(
        level.Spacing[axis] * level.Size[axis], spacing[axis] * levels[0].Size[axis]);
    }
  }
}

TEST(PyramidGeometry, AutomaticStopsBeforeALevelUnderTheMinimumSize)
{
  PyramidOptions options;
  options.MinimumLevelSize = 22;
  EXPECT_EQ(PlanPyramid({ 256, 256, 68 }, { 1, 1, 1 }, options).size(), 3u);
  options.MinimumLevelSize = 23;
  EXPECT_EQ(PlanPyramid({ 256, 256, 68 }, { 1, 1, 1 }, options).size(), 2u);
}

TEST(PyramidGeometry, AxesOfOneVoxelStayAndDoNotCount)
{
  const auto levels = PlanPyramid({ 100, 80, 1 }, { 1, 1, 0.001 }, {});
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(levels[3].Size, (LevelSize{ 18, 15, 1 }));
  EXPECT_DOUBLE_EQ(levels[0].Unit, 1.0) << "no two voxels have a distance along z";
  EXPECT_DOUBLE_EQ(levels[3].Spacing[2], 0.001);
}

TEST(PyramidGeometry, SizesBeyond32BitsWorkAsNumbersDo)
{
  const auto levels = PlanPyramid({ 2000000, 3000, 4000 }, { 1, 1, 1 }, {});
  EXPECT_EQ(levels[0].NumberOfVoxels(), 24000000000000LL);
  EXPECT_EQ(levels[1].Size[0], 1154700);
  EXPECT_EQ(levels[1].NumberOfVoxels(), 1154700LL * 1732 * 2309);
}

TEST(PyramidGeometry, RefusesReductionFactorsOutsideTheirRange)
{
  for (const double factor : { 1.0, 2.0, 0.0, -1.5, 2.5, std::numeric_limits<double>::quiet_NaN() })
  {
    const std::string error = ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, WithFactor(factor));
    EXPECT_TRUE(Has(error, "Reduction Factor")) << factor << ": " << error;
    EXPECT_TRUE(Has(error, "between 1 and 2")) << factor << ": " << error;
  }
  EXPECT_EQ(ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, WithFactor(1.01)), "");
  EXPECT_EQ(ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, WithFactor(1.99)), "");
}

TEST(PyramidGeometry, RefusesMoreLevelsThanTheImageGivesAndSaysHowMany)
{
  PyramidOptions options;
  options.NumberOfLevels = 9;
  const std::string error = ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, options);
  EXPECT_TRUE(Has(error, "at most 7 levels"));
  options.NumberOfLevels = 7; // 64 36 20 11 6 3 1
  EXPECT_EQ(PlanPyramid({ 64, 64, 64 }, { 1, 1, 1 }, options).size(), 7u);
}

TEST(PyramidGeometry, RefusesNegativeOptions)
{
  PyramidOptions options;
  options.NumberOfLevels = -1;
  EXPECT_TRUE(Has(ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, options), "Number Of Levels is -1"));
  options.NumberOfLevels = 0;
  options.MinimumLevelSize = 0;
  EXPECT_TRUE(Has(ErrorOf({ 64, 64, 64 }, { 1, 1, 1 }, options), "Minimum Level Size is 0"));
}

TEST(PyramidGeometry, RefusesImagesWithoutExtentOrDistance)
{
  EXPECT_TRUE(Has(ErrorOf({ 0, 4, 4 }, { 1, 1, 1 }, {}), "empty"));
  EXPECT_TRUE(Has(ErrorOf({ 4, 4, 4 }, { 1, 0, 1 }, {}), "axis y"));
  EXPECT_EQ(ErrorOf({ 4, 1, 4 }, { 1, 0, 1 }, {}), "") << "one voxel needs no spacing";
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/PyramidGeometry.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(PyramidGeometry, SizesFollowEquation4)
{
  const auto levels = PlanPyramid({ 256, 256, 68 }, { 1, 1, 1.0625 }, {});
  ASSERT_EQ(levels.size(), 4u) << "68, 39, 22, 12; 6 is below MinimumLevelSize";
  EXPECT_EQ(levels[0].Size, (LevelSize{ 256, 256, 68 }));
  EXPECT_EQ(levels[1].Size, (LevelSize{ 147, 147, 39 }));
  EXPECT_EQ(levels[2].Size, (LevelSize{ 84, 84, 22 }));
  EXPECT_EQ(levels[3].Size, (LevelSize{ 48, 48, 12 }));
}

TEST(PyramidGeometry, AutomaticLevelsRespectMinimumSize)
{
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

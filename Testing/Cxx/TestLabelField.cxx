// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelTestTools.h"

using namespace volumic;

namespace
{
LabelField FieldOf(
  const LabelMap& map, int object, double sigma = 2., Executor& executor = OnThisThread())
{
  LabelFieldOptions options;
  options.Sigma = sigma;
  const LabelBricks bricks(map, executor);
  return MakeLabelField(bricks, object, options, executor, VoxelBox::Of(bricks.Size()));
}

/** Return the number of voxel centres at which the field has the wrong sign or is 0. */
int CountWrongSigns(const LabelMap& map, int object, const LabelField& field)
{
  int wrong = 0;
  ForBox(field.Box.First, field.Box.End,
    [&](int i, int j, int k)
    {
      const float value = ValueAt(field, i, j, k);
      wrong += (map.At(i, j, k) == object) != (value > 0.f) || value == 0.f;
    });
  return wrong;
}
}

TEST(LabelField, HasCorrectSignsInNoise)
{
  for (const double sigma : { 0., 0.5, 2., 6. })
  {
    const LabelMap map = NoisyLabelMap({ 17, 14, 12 }, 2, 11);
    EXPECT_EQ(CountWrongSigns(map, 1, FieldOf(map, 1, sigma)), 0) << sigma;
    EXPECT_EQ(CountWrongSigns(map, 2, FieldOf(map, 2, sigma)), 0) << sigma;
  }
}

TEST(LabelField, PreservesPartsOneVoxelThick)
{
  const auto sheetAndThread = [](int i, int j, int k)
  { return (i == 10 && j > 3 && j < 18) || (j == 12 && k == 9 && i > 3 && i < 18) ? 1 : 0; };
  const LabelMap map = MakeLabelMap({ 22, 22, 22 }, 1, sheetAndThread);
  const LabelField field = FieldOf(map, 1);
  EXPECT_EQ(CountWrongSigns(map, 1, field), 0);
  EXPECT_GE(ValueAt(field, 10, 10, 10), 0.35f) << "far enough from the triangles";
  EXPECT_GE(ValueAt(field, 5, 12, 9), 0.35f);
}

namespace
{
/** Return the position of the zero between an inside (0) and an outside voxel centre (1). */
double CrossingOf(float inside, float outside)
{
  return inside / (static_cast<double>(inside) - outside);
}
}

TEST(LabelFieldOfThinParts, PreservesWidthOfRodsAndVoxels)
{
  const LabelMap rod = MakeLabelMap({ 32, 24, 24 }, 1,
    [](int i, int j, int k) { return i > 5 && i < 26 && j == 12 && k == 12 ? 1 : 0; });
  const LabelField field = FieldOf(rod, 1);
  const LabelMap voxel = MakeLabelMap(
    { 24, 24, 24 }, 1, [](int i, int j, int k) { return i == 12 && j == 12 && k == 12 ? 1 : 0; });
  const LabelField small = FieldOf(voxel, 1);
  const float middle = ValueAt(field, 16, 12, 12);
  for (const int side : { -1, 1 })
  {
    EXPECT_NEAR(CrossingOf(middle, ValueAt(field, 16, 12 + side, 12)), 0.5, 0.12);
    EXPECT_NEAR(CrossingOf(middle, ValueAt(field, 16, 12, 12 + side)), 0.5, 0.12);
    EXPECT_NEAR(
      CrossingOf(ValueAt(small, 12, 12, 12), ValueAt(small, 12 + side, 12, 12)), 0.6, 0.12);
  }
}

TEST(LabelFieldWithTolerance, SmoothsBumpsAndPitsButPreservesThinParts)
{
  // A slab with a bump, a pit and a rod.
  const LabelMap map = MakeLabelMap({ 40, 40, 24 }, 2,
    [](int i, int j, int k)
    {
      const bool isBump = i == 8 && j == 8 && k == 12;
      const bool isPit = i == 20 && j == 8 && k == 11;
      const bool isRod = i == 20 && j == 28 && k < 20;
      return (k >= 5 && k < 12 && !isPit) || isBump || isRod ? 1 : 2;
    });
  LabelFieldOptions options;
  options.Tolerance = 0.5;
  const LabelBricks bricks(map, OnThisThread());
  const VoxelBox all = VoxelBox::Of(bricks.Size());
  const LabelField field = MakeLabelField(bricks, 1, options, OnThisThread(), all);
  EXPECT_LT(ValueAt(field, 8, 8, 12), 0.f);
  EXPECT_GE(ValueAt(field, 8, 8, 12), -0.5f);
  EXPECT_GT(ValueAt(field, 20, 8, 11), 0.f);
  EXPECT_LE(ValueAt(field, 20, 8, 11), 0.5f);
  EXPECT_GT(ValueAt(field, 20, 28, 18), 0.3f);
  const LabelField others = MakeLabelField(bricks, 2, options, OnThisThread(), all);
  EXPECT_NEAR(ValueAt(others, 8, 8, 12), -ValueAt(field, 8, 8, 12), 0.02);
  EXPECT_NEAR(ValueAt(others, 20, 8, 11), -ValueAt(field, 20, 8, 11), 0.02);
}

TEST(LabelFieldOfThinParts, PreservesThicknessWithLargeSigma)
{
  const LabelMap map =
    MakeLabelMap({ 32, 32, 32 }, 1, [](int, int, int k) { return k == 15 || k == 16 ? 1 : 0; });
  const LabelField field = FieldOf(map, 1, 4.);
  EXPECT_EQ(CountWrongSigns(map, 1, field), 0);
  EXPECT_NEAR(CrossingOf(ValueAt(field, 16, 16, 16), ValueAt(field, 16, 16, 17)), 0.5, 0.3);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/SmallParts.h"
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

/** A 4 x 4 x 4 block and 2 separate voxels of object 1 in object 2, and one voxel of object 3. */
LabelMap Parts()
{
  return MakeLabelMap({ 12, 8, 8 }, 3,
    [](int i, int j, int k)
    {
      if (k == 4 && j == 4 && (i == 8 || i == 9))
      {
        return 1;
      }
      if (i == 11)
      {
        return k == 2 && j == 2 ? 3 : 0;
      }
      return i < 4 && j < 4 && k < 4 ? 1 : 2;
    });
}

long VoxelsOf(const LabelMap& map, int object)
{
  long count = 0;
  map.ForParts(VoxelBox::Of(map.Size()),
    [&](const VoxelBox& part, LabelMap::Number other)
    { count += other == object ? static_cast<long>(part.Count()) : 0; });
  return count;
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

TEST(SmallParts, AreReassignedToNeighbours)
{
  LabelMap map = Parts();
  ReassignSmallParts(map, { 1, 2, 3 }, 3, false);
  EXPECT_EQ(map.At(8, 4, 4), 2);
  EXPECT_EQ(map.At(9, 4, 4), 2);
  EXPECT_EQ(map.At(11, 2, 2), 0); // It shares more faces with the background than with object 2.
  EXPECT_EQ(VoxelsOf(map, 1), 64);
  map = Parts();
  ReassignSmallParts(map, { 1, 2, 3 }, 2, false);
  EXPECT_EQ(map.At(8, 4, 4), 1) << "not smaller than the limit";
  EXPECT_EQ(VoxelsOf(map, 3), 0);
  map = Parts();
  ReassignSmallParts(map, { 1, 2, 3 }, 0, true); // all except for the largest
  EXPECT_EQ(VoxelsOf(map, 1), 64);
  EXPECT_EQ(VoxelsOf(map, 3), 1); // the largest part of its object
}

TEST(SmallParts, AreNotReassignedToSmallParts)
{
  LabelMap map = Parts();
  ReassignSmallParts(map, { 1, 2, 3 }, 1000000, false);
  EXPECT_EQ(VoxelsOf(map, 0), static_cast<long>(VoxelBox::Of(map.Size()).Count()));
  // Two voxels of object 1 in a part of object 3 in object 2: all become object 2.
  map = MakeLabelMap({ 9, 9, 9 }, 3,
    [](int i, int j, int k)
    {
      const bool isNear = std::abs(i - 4) < 2 && std::abs(j - 4) < 2 && std::abs(k - 4) < 2;
      return i == 4 && j == 4 && k > 3 && k < 6 ? 1 : isNear ? 3 : 2;
    });
  ReassignSmallParts(map, { 1, 2, 3 }, 100, false);
  EXPECT_EQ(VoxelsOf(map, 2), 729);
}

TEST(SmallParts, AreCornerConnected)
{
  // Test both diagonals.
  for (const int sign : { 1, -1 })
  {
    LabelMap map = MakeLabelMap({ 6, 6, 6 }, 1,
      [=](int i, int j, int k)
      { return j == k && j > 0 && j < 5 && i == (sign > 0 ? j : 5 - j) ? 1 : 0; });
    ReassignSmallParts(map, { 1 }, 4, false);
    EXPECT_EQ(VoxelsOf(map, 1), 4) << sign;
  }
}

TEST(SmallParts, OfUnselectedObjectsAreKept)
{
  LabelMap map = Parts();
  ReassignSmallParts(map, { 1 }, 3, true);
  EXPECT_EQ(map.At(8, 4, 4), 2);
  EXPECT_EQ(VoxelsOf(map, 3), 1);
  EXPECT_EQ(VoxelsOf(map, 1), 64);
}

namespace
{
/** Return the voxels of the part that contains a voxel. */
std::set<std::array<int, 3>> PartAt(const LabelMap& map, const std::array<int, 3>& voxel)
{
  std::set<std::array<int, 3>> part = { voxel };
  std::vector<std::array<int, 3>> next = { voxel };
  while (!next.empty())
  {
    const auto [i, j, k] = next.back();
    next.pop_back();
    ForBox({ i - 1, j - 1, k - 1 }, { i + 2, j + 2, k + 2 },
      [&, i = i, j = j, k = k](int x, int y, int z)
      {
        if (map.At(x, y, z) == map.At(i, j, k) && part.insert({ x, y, z }).second)
        {
          next.push_back({ x, y, z });
        }
      });
  }
  return part;
}
}

TEST(SmallParts, AreSeparatedIntoObjects)
{
  LabelMap map = MakeLabelMap({ 12, 5, 5 }, 2,
    [](int i, int j, int k)
    {
      const bool isInRow = j == 2 && k == 2;
      return isInRow && i < 2         ? 1
        : isInRow && i > 2 && i < 6   ? 1
        : isInRow && i == 7           ? 2
        : i == 8 && j == 3 && k == 3  ? 2
        : i == 11 && j == 0 && k == 4 ? 1
                                      : 0;
    });
  SeparateParts(map);
  EXPECT_EQ(map.NumberOfObjects, 4);
  EXPECT_EQ(map.WholeOf, (std::vector<LabelMap::Number>{ 0, 1, 2, 1, 1 }));
  EXPECT_EQ(map.At(3, 2, 2), 1) << "the largest part";
  EXPECT_EQ(map.At(0, 2, 2), 3);
  EXPECT_EQ(map.At(11, 0, 4), 4) << "the smallest one comes last";
  EXPECT_EQ(map.At(7, 2, 2), 2);
  EXPECT_EQ(map.At(8, 3, 3), 2) << "joined by a corner";
}

TEST(SmallParts, LargePartsAreKept)
{
  for (unsigned seed = 1; seed < 6; ++seed)
  {
    const LabelMap noise = NoisyLabelMap({ 11, 13, 17 }, 9, seed);
    LabelMap map = noise;
    ReassignSmallParts(map, { 1, 2, 3, 4, 5, 6, 7, 8, 9 }, 4, false);
    int reassigned = 0;
    ForVoxels(map.Size(),
      [&](int i, int j, int k)
      {
        const int object = noise.At(i, j, k);
        const bool isKept = object == 0 || PartAt(noise, { i, j, k }).size() >= 4;
        EXPECT_LE(map.At(i, j, k), 9);
        EXPECT_TRUE(!isKept || map.At(i, j, k) == object) << i << " " << j << " " << k;
        reassigned += isKept ? 0 : 1;
      });
    EXPECT_GT(reassigned, 100);
  }
}

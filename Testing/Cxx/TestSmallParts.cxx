// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/SmallParts.h"

#include "LabelTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

using namespace volumic;

namespace
{
/** A block of object 1 of 4 x 4 x 4 in a corner of object 2, two voxels of 1 apart, one of 3. */
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
  return static_cast<long>(std::count(map.Voxels.begin(), map.Voxels.end(), object));
}
}

TEST(SmallParts, GoToWhatIsAboutThem)
{
  LabelMap map = Parts();
  GiveAwaySmallParts(map, 3, 3, false);
  EXPECT_EQ(map.At(8, 4, 4), 2);
  EXPECT_EQ(map.At(9, 4, 4), 2);
  EXPECT_EQ(map.At(11, 2, 2), 0); // More faces of it are at the outside than at 2.
  EXPECT_EQ(VoxelsOf(map, 1), 64);
}

TEST(SmallParts, OfTheLargestSizeStay)
{
  LabelMap map = Parts();
  GiveAwaySmallParts(map, 3, 2, false);
  EXPECT_EQ(map.At(8, 4, 4), 1);
  EXPECT_EQ(VoxelsOf(map, 3), 0);
}

TEST(SmallParts, AreAllButTheLargest)
{
  LabelMap map = Parts();
  GiveAwaySmallParts(map, 3, 0, true);
  EXPECT_EQ(VoxelsOf(map, 1), 64);
  EXPECT_EQ(VoxelsOf(map, 3), 1); // It is the largest of its object.
}

TEST(SmallParts, GoToNothingThatGoes)
{
  LabelMap map = Parts();
  GiveAwaySmallParts(map, 3, 1000000, false);
  EXPECT_EQ(VoxelsOf(map, 0), static_cast<long>(map.Voxels.size()));
  // Two voxels of 1 in some of 3 in 2: all of it is 2 then.
  map = MakeLabelMap({ 9, 9, 9 }, 3,
    [](int i, int j, int k)
    {
      const bool isNear = std::abs(i - 4) < 2 && std::abs(j - 4) < 2 && std::abs(k - 4) < 2;
      return i == 4 && j == 4 && k > 3 && k < 6 ? 1 : isNear ? 3 : 2;
    });
  GiveAwaySmallParts(map, 3, 100, false);
  EXPECT_EQ(VoxelsOf(map, 2), 729);
}

TEST(SmallParts, JoinedByACornerAreOne)
{
  // Along either diagonal: the first voxel is at one of the ends, or beyond others.
  for (const int sign : { 1, -1 })
  {
    LabelMap map = MakeLabelMap({ 6, 6, 6 }, 1,
      [=](int i, int j, int k)
      { return j == k && j > 0 && j < 5 && i == (sign > 0 ? j : 5 - j) ? 1 : 0; });
    GiveAwaySmallParts(map, 1, 4, false);
    EXPECT_EQ(VoxelsOf(map, 1), 4) << sign;
  }
}

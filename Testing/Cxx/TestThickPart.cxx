// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ThickPart.h"
#include "Core/Image/VoxelNumbers.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
constexpr std::array<int, 3> Size = { 12, 11, 10 };

std::vector<std::uint8_t> Marks(const std::function<bool(int, int, int)>& isObject)
{
  std::vector<std::uint8_t> marks;
  const VoxelNumbers numbers(Size);
  for (std::int64_t voxel = 0; voxel < numbers.Count(); ++voxel)
  {
    const std::array<int, 3> place = numbers.PlaceOf(voxel);
    marks.push_back(isObject(place[0], place[1], place[2]));
  }
  return marks;
}

bool HasThick(
  const std::vector<std::uint8_t>& marks, int minimum, const std::array<int, 3>& size = Size)
{
  return HasThickPart(
    [&marks](std::int64_t voxel) { return marks[voxel] != 0; }, size, { minimum, 2 });
}

bool HasAny(const std::vector<std::uint8_t>& marks, int minimum)
{
  return HasThickPart(
    [&marks](std::int64_t voxel) { return marks[voxel] != 0; }, Size, { minimum, 1 });
}

bool IsIn(int x, int low, int high)
{
  return x >= low && x <= high;
}
}

TEST(ThickPart, CountsTheVoxelsOfCubes)
{
  const auto rod =
    Marks([](int i, int j, int k) { return IsIn(i, 1, 9) && IsIn(j, 3, 4) && IsIn(k, 5, 6); });
  EXPECT_TRUE(HasThick(rod, 36));
  EXPECT_FALSE(HasThick(rod, 37));
}

TEST(ThickPart, LeavesOutWhatIsThin)
{
  const auto plate = Marks([](int i, int, int) { return i == 6; });
  EXPECT_FALSE(HasThick(plate, 1));
  // A cube with a long wire.
  const auto wire = Marks([](int i, int j, int k)
    { return (IsIn(i, 0, 1) && IsIn(j, 0, 1) && IsIn(k, 0, 1)) || (j == 0 && k == 0); });
  EXPECT_TRUE(HasThick(wire, 8));
  EXPECT_FALSE(HasThick(wire, 9));
}

TEST(ThickPart, CountsAllVoxelsWhereThinnessIsAllowed)
{
  // The plate, and a wire that touches it by a corner only; both to the rim of the image.
  const auto plate = Marks([](int i, int j, int k)
    { return i == 11 || (i == 10 && j == 0 && k == 0) || (i == 9 && j == 1); });
  EXPECT_TRUE(HasAny(plate, Size[1] * Size[2] + 1));
  EXPECT_FALSE(HasAny(plate, Size[1] * Size[2] + 2));
  EXPECT_FALSE(HasThick(plate, 1));
}

TEST(ThickPart, DoesNotAddUpParts)
{
  // Two of 16 voxels; they touch at the corner of the box.
  const auto parts = Marks([](int i, int j, int k)
    { return IsIn(j, 2, 3) && IsIn(k, 2, 3) && (IsIn(i, 0, 3) || IsIn(i, 6, 9)); });
  EXPECT_TRUE(HasThick(parts, 16));
  EXPECT_FALSE(HasThick(parts, 17));
}

TEST(ThickPart, IsCountedAcrossItsTurns)
{
  // Two arms along x and what joins them, far from where the part begins: 3 x 2 x 2 x (6, 2, 6).
  const auto bent = Marks([](int i, int j, int k)
    { return IsIn(j, 2, 3) && (IsIn(k, 1, 2) || IsIn(k, 7, 8) || IsIn(i, 8, 9)) && i >= 4 &&
        i <= 9 && IsIn(k, 1, 8); });
  EXPECT_TRUE(HasThick(bent, 2 * 24 + 16));
  EXPECT_FALSE(HasThick(bent, 2 * 24 + 17));
}

TEST(ThickPart, EndsAtTheBorderOfTheImage)
{
  // Rows do not go on in the next one.
  const auto ends = Marks([](int i, int j, int k)
    { return (i >= 10 && j <= 1 && k <= 1) || (i <= 1 && IsIn(j, 1, 2) && k <= 1); });
  EXPECT_TRUE(HasThick(ends, 8));
  EXPECT_FALSE(HasThick(ends, 9));
}

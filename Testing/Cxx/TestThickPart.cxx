// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ThickPart.h"
#include "Core/Image/VoxelNumbers.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
constexpr std::array<int, 3> Size = { 12, 11, 10 };

using Voxels = std::function<bool(int, int, int)>;

/** Whether a part has at least so many voxels in cubes of a side. */
bool HasPart(const Voxels& isObject, int minimum, int side)
{
  const VoxelNumbers numbers(Size);
  return HasThickPart(
    [&](std::int64_t voxel)
    {
      const std::array<int, 3> ijk = numbers.IjkOf(voxel);
      return isObject(ijk[0], ijk[1], ijk[2]);
    },
    Size, { minimum, side });
}

bool IsIn(int x, int low, int high)
{
  return x >= low && x <= high;
}
}

TEST(ThickPart, HasSizeOfLargestThickPart)
{
  struct Case
  {
    const char* Name;
    Voxels IsObject;
    int Thick; ///< voxels in cubes of 2 x 2 x 2; 0: none
    int All;
  };
  for (const Case& test :
    { Case{ "rod",
        [](int i, int j, int k) { return IsIn(i, 1, 9) && IsIn(j, 3, 4) && IsIn(k, 5, 6); }, 36,
        36 },
      Case{ "plate", [](int i, int, int) { return i == 6; }, 0, 110 },
      Case{ "cube with a wire",
        [](int i, int j, int k) { return (IsIn(i, 0, 1) && j < 2 && k < 2) || (j == 0 && k == 0); },
        8, 18 },
      Case{ "plate and wire at a corner",
        [](int i, int j, int k)
        { return i == 11 || (i == 10 && j == 0 && k == 0) || (i == 9 && j == 1); },
        0, 111 },
      Case{ "two parts",
        [](int i, int j, int k)
        { return IsIn(j, 2, 3) && IsIn(k, 2, 3) && (IsIn(i, 0, 3) || IsIn(i, 6, 9)); },
        16, 16 },
      Case{ "two connected arms",
        [](int i, int j, int k)
        { return IsIn(j, 2, 3) && IsIn(k, 1, 8) && IsIn(i, 4, 9) && (k < 3 || k > 6 || i > 7); },
        64, 64 },
      Case{ "ends of consecutive rows",
        [](int i, int j, int k)
        { return (i >= 10 && j <= 1 && k <= 1) || (i <= 1 && IsIn(j, 1, 2) && k <= 1); },
        8, 8 } })
  {
    SCOPED_TRACE(test.Name);
    EXPECT_EQ(HasPart(test.IsObject, std::max(1, test.Thick), 2), test.Thick > 0);
    EXPECT_FALSE(HasPart(test.IsObject, test.Thick + 1, 2));
    EXPECT_TRUE(HasPart(test.IsObject, test.All, 1));
    EXPECT_FALSE(HasPart(test.IsObject, test.All + 1, 1));
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/ThickPart.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Image/VoxelNumbers.h"
#include "Core/Image/VoxelValues.h"
#include "TestPrelude.h"

#include <cstring>

using namespace volumic;

namespace
{
/** Bases with and without an exact float. */
constexpr double Bases[] = { 0., 226.5, -1024., 1. / 3., 1150.1, 4e-5, 1e-30, 70000.0000001,
  0x1.000002p-9, -0x1.fffffep-15, 1e12 };

std::uint32_t Bits(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/** Return random voxels with the extreme values of the type, limited to +-1e9. */
template <typename T>
std::vector<T> AnyVoxels(std::size_t count)
{
  std::mt19937 random(7);
  constexpr double widest = 1e9;
  const double low = std::max(static_cast<double>(std::numeric_limits<T>::lowest()), -widest);
  const double high = std::min(static_cast<double>(std::numeric_limits<T>::max()), widest);
  std::uniform_real_distribution<double> any(low, high);
  std::vector<T> voxels(count);
  for (T& voxel : voxels)
  {
    voxel = static_cast<T>(any(random));
  }
  voxels[count / 2] = static_cast<T>(low);
  voxels[count / 3] = static_cast<T>(high);
  return voxels;
}

template <typename T>
class VoxelValuesOfType : public testing::Test
{
};
using VoxelTypes = testing::Types<char, signed char, unsigned char, short, unsigned short, int,
  unsigned int, long, unsigned long, long long, unsigned long long, float, double>;
TYPED_TEST_SUITE(VoxelValuesOfType, VoxelTypes);

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

TYPED_TEST(VoxelValuesOfType, EqualConvertedVoxels)
{
  using T = TypeParam;
  // All values of types with 8 and 16 bits.
  std::vector<T> voxels = AnyVoxels<T>(1 << 16);
  for (std::size_t i = 0; i < voxels.size() && sizeof(T) <= 2; ++i)
  {
    voxels[i] = static_cast<T>(i);
  }
  for (const double base : Bases)
  {
    const VoxelValues values(voxels.data(), base);
    std::vector<float> copied(voxels.size() - 1);
    values.Copy(1, static_cast<std::ptrdiff_t>(copied.size()), copied.data());
    for (std::size_t i = 1; i < voxels.size(); ++i)
    {
      const std::uint32_t expected =
        Bits(static_cast<float>(static_cast<double>(voxels[i]) - base));
      ASSERT_EQ(Bits(values[static_cast<std::ptrdiff_t>(i)]), expected)
        << "base " << base << " voxel " << +voxels[i];
      ASSERT_EQ(Bits(copied[i - 1]), expected) << "base " << base << " voxel " << +voxels[i];
    }
  }
}

TEST(VoxelBox, WithoutCoversTheRestOnce)
{
  const VoxelBox box = VoxelBox::Of({ 4, 5, 6 });
  for (const VoxelBox& other : { VoxelBox{ { 1, 2, 3 }, { 3, 4, 5 } },
         VoxelBox{ { 2, -1, 3 }, { 9, 9, 9 } }, VoxelBox{ { 4, 0, 0 }, { 5, 5, 6 } } })
  {
    std::vector<int> covered(box.Count());
    std::vector<VoxelBox> parts = box.Without(other);
    parts.push_back(box.CommonWith(other));
    for (const VoxelBox& part : parts)
    {
      part.ForVoxels([&](int i, int j, int k) { ++covered[box.NumberOf(i, j, k)]; });
    }
    EXPECT_EQ(covered, std::vector<int>(box.Count(), 1));
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

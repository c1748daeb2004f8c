// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Image/Field.h"
#include "Core/Image/VoxelValues.h"
#include "TestPrelude.h"

#include <cstring>

using namespace volumic;

namespace
{
Executor Threads;

/** Bases that are floats, and bases that are not. */
constexpr double Bases[] = { 0., 226.5, -1024., 1. / 3., 1150.1, 4e-5, 1e-30, 70000.0000001,
  0x1.000002p-9, -0x1.fffffep-15, 1e12 };

std::uint32_t Bits(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/** What voxels were converted to, one after the other, when levels were copied. */
template <typename T>
float Converted(T voxel, double base)
{
  return static_cast<float>(static_cast<double>(voxel) - base);
}

/** Any numbers of the type, the extreme ones too; of wide types such that a double keeps apart. */
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

constexpr std::array<int, 3> Size = { 9, 8, 7 };
constexpr std::size_t Count = 9 * 8 * 7;

LevelImage ImageOf(const VoxelValues& values, double base)
{
  LevelImage image;
  image.Values = values;
  image.Base = base;
  image.Size = Size;
  image.Step = { 1., 1.25, 1.5 };
  return image;
}
}

TYPED_TEST(VoxelValuesOfType, AreTheBitsOfAConversion)
{
  using T = TypeParam;
  // Of 8 and 16 bits all numbers; of floats the difference is taken in double.
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
      const std::uint32_t expected = Bits(Converted(voxels[i], base));
      ASSERT_EQ(Bits(values[static_cast<std::ptrdiff_t>(i)]), expected)
        << "base " << base << " voxel " << +voxels[i];
      ASSERT_EQ(Bits(copied[i - 1]), expected) << "base " << base << " voxel " << +voxels[i];
    }
  }
}

TYPED_TEST(VoxelValuesOfType, MakeTheSameField)
{
  using T = TypeParam;
  const std::vector<T> voxels = AnyVoxels<T>(Count);
  for (const double base : { 30.5, 30.1 })
  {
    std::vector<float> converted;
    for (const T voxel : voxels)
    {
      converted.push_back(Converted(voxel, base));
    }
    for (const Border border : { Border::Background, Border::Replicate })
    {
      SurfaceOptions options;
      options.IsoValue = 30.1;
      options.BorderValue = border;
      const Field typed(
        ImageOf(VoxelValues(voxels.data(), base), base), options, Threads);
      const Field plain(ImageOf(converted.data(), base), options, Threads);
      EXPECT_EQ(Bits(typed.Highest()), Bits(plain.Highest()));
      EXPECT_EQ(Bits(typed.Lowest()), Bits(plain.Lowest()));
      EXPECT_EQ(Bits(typed.Background()), Bits(plain.Background()));
      EXPECT_EQ(Bits(typed.TypicalSlope()), Bits(plain.TypicalSlope()));
      // Inside and about the border.
      for (int n = 0; n < 500; ++n)
      {
        const auto place = [n](int axis, double factor)
        { return static_cast<float>(std::fmod(n * factor, Size[axis] * 1.5 + 4.) - 2.); };
        const Vector p(place(0, 0.731), place(1, 0.417), place(2, 0.913));
        ASSERT_EQ(Bits(typed.ValueAt(p)), Bits(plain.ValueAt(p)));
        const Field::Sample a = typed.At(p);
        const Field::Sample b = plain.At(p);
        ASSERT_EQ(Bits(a.Value), Bits(b.Value));
        ASSERT_EQ(Bits(a.Gradient.X), Bits(b.Gradient.X));
        ASSERT_EQ(Bits(a.Gradient.Y), Bits(b.Gradient.Y));
        ASSERT_EQ(Bits(a.Gradient.Z), Bits(b.Gradient.Z));
      }
      float row[5];
      typed.Row(2, 3, 4, 5, row);
      for (int i = 0; i < 5; ++i)
      {
        EXPECT_EQ(Bits(row[i]), Bits(plain.Voxel(2 + i, 3, 4)));
        EXPECT_EQ(Bits(row[i]), Bits(typed.Voxel(2 + i, 3, 4)));
      }
    }
  }
}

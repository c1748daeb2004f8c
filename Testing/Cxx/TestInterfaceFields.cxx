// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "InterfaceTestTools.h"

using namespace volumic;

TEST(InterfaceFields, AreLargestWhereTheMapSaysSo)
{
  const InterfaceScene scene(ManyCells(28, 6, 5));
  ForVoxels({ 28, 28, 28 }, [&](int i, int j, int k)
    { ASSERT_EQ(scene.Fields->LargestAt(i, j, k), scene.Map.At(i, j, k)) << i << j << k; });
}

TEST(InterfaceFields, AreInterpolatedWithTheirGradient)
{
  const InterfaceScene scene(ManyCells(24, 3, 1));
  const float step = 0.01f;
  for (const Vector& place : { Vector(10.3f, 11.6f, 12.2f), Vector(7.5f, 15.4f, 9.7f) })
  {
    for (int object = 0; object <= 3; ++object)
    {
      const InterfaceFields::Sample sample = scene.Fields->Interpolate(object, place);
      const auto slope = [&](const Vector& way)
      {
        return (scene.Fields->ValueAt(object, place + way * step) -
                 scene.Fields->ValueAt(object, place - way * step)) / (2.f * step);
      };
      EXPECT_NEAR(sample.Gradient.X, slope(Vector(1.f, 0.f, 0.f)), 2e-3);
      EXPECT_NEAR(sample.Gradient.Y, slope(Vector(0.f, 1.f, 0.f)), 2e-3);
      EXPECT_NEAR(sample.Gradient.Z, slope(Vector(0.f, 0.f, 1.f)), 2e-3);
    }
  }
  EXPECT_EQ(scene.Fields->ValueAt(2, Vector(10.f, 11.f, 12.f)), scene.Fields->At(2, 10, 11, 12));
}

TEST(InterfaceFields, OfTheOutsideAreOppositeToThoseOfTheOneObjectInIt)
{
  // Sizes of whole bricks, and others: the map's end is not seen.
  for (const int side : { 28, 27, 25 })
  {
    const InterfaceScene scene(MakeLabelMap({ side, side, side }, 1,
      [=](int i, int j, int k)
      { return std::min({ i, j, k }) >= 4 && std::max({ i, j, k }) < side - 4 ? 1 : 0; }));
    ForBox({ 2, 2, 2 }, { side - 2, side - 2, side - 2 }, [&](int i, int j, int k)
      { ASSERT_NEAR(scene.Fields->At(0, i, j, k), -scene.Fields->At(1, i, j, k), 0.1) << side; });
  }
}

TEST(InterfaceFields, PushAVoxelToItsOwnSide)
{
  InterfaceScene scene(FourBlocks(6));
  const std::array<int, 3> voxel = { 9, 9, 9 }; // the last of object 1
  ASSERT_EQ(scene.Map.At(9, 9, 9), 1);
  const float own = scene.Fields->At(1, 9, 9, 9);
  const float other = scene.Fields->At(2, 9, 9, 9);
  const float beyond = scene.Fields->At(2, 10, 9, 9);
  scene.Fields->Push(1, voxel, 0.25f);
  scene.Fields->Push(2, voxel, 0.25f);
  EXPECT_FLOAT_EQ(scene.Fields->At(1, 9, 9, 9), own + 0.25f);
  EXPECT_FLOAT_EQ(scene.Fields->At(2, 9, 9, 9), other - 0.25f);
  EXPECT_FLOAT_EQ(scene.Fields->At(2, 10, 9, 9), beyond); // the other side keeps its own
  EXPECT_EQ(scene.Fields->LargestAt(10, 9, 9), scene.Map.At(10, 9, 9));
}

TEST(InterfaceFields, ShiftALittleAtMost)
{
  InterfaceScene scene(FourBlocks(5));
  const Vector place(6.f, 6.f, 6.f);
  const float before = scene.Fields->ValueAt(1, place);
  scene.Fields->Shift(1, 0.05f);
  EXPECT_NEAR(scene.Fields->ValueAt(1, place), before + 0.05f, 1e-5);
  scene.Fields->Shift(1, 9.f);
  EXPECT_LT(scene.Fields->ValueAt(1, place), before + 0.3f);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceLattice.h"
#include "Core/Interfaces/LatticeCutter.h"
#include "InterfaceTestTools.h"

using namespace volumic;

namespace
{
constexpr double EdgeOfVoxels = 1.36;

using Pitches = std::array<int, 3>;

InterfaceMesh StartOf(const InterfaceScene& scene, const Pitches& pitch)
{
  LatticeCutter cutter(*scene.Fields, pitch);
  cutter.FindMiddles(OnThisThread());
  const std::array<int, 3>& bricks = scene.Bricks->Size();
  for (int k = 0; k < bricks[2]; ++k)
  {
    for (int j = 0; j < bricks[1]; ++j)
    {
      for (int i = 0; i < bricks[0]; ++i)
      {
        cutter.CutBrick(i, j, k);
      }
    }
  }
  return cutter.Take();
}

Pitches PitchOf(const LabelMap& map, double edge = EdgeOfVoxels)
{
  const InterfaceScene scene(map);
  return InterfaceLattice(*scene.Fields, edge, OnThisThread()).Pitch();
}

/** Voxels by chance, with nothing about them. */
LabelMap Noise(int objects, unsigned seed)
{
  const LabelMap inner = NoisyLabelMap({ 8, 9, 7 }, objects, seed);
  constexpr int margin = LabelBricks::Side;
  return MakeLabelMap({ 16, 17, 15 }, objects,
    [&](int i, int j, int k) { return inner.At(i - margin, j - margin, k - margin); });
}
}

class InterfaceLatticeOfNoise : public testing::TestWithParam<int>
{
};

TEST_P(InterfaceLatticeOfNoise, IsSoundWithAnyPitch)
{
  for (const int objects : { 1, 2, 3, 7 })
  {
    SCOPED_TRACE(objects);
    const InterfaceScene scene(Noise(objects, static_cast<unsigned>(GetParam() * 10 + objects)));
    for (const Pitches& pitch :
      { Pitches{ 1, 1, 1 }, Pitches{ 2, 2, 2 }, Pitches{ 2, 2, 1 }, Pitches{ 1, 2, 1 } })
    {
      ExpectSound(StartOf(scene, pitch));
    }
  }
}

TEST_P(InterfaceLatticeOfNoise, IsSoundAndFlatWhereItEndsAtABox)
{
  for (const int objects : { 1, 7 })
  {
    const LabelMap noise =
      NoisyLabelMap({ 16, 17, 15 }, objects, static_cast<unsigned>(GetParam() * 10 + objects));
    for (const VoxelBox& box : { VoxelBox{ { 4, 4, 4 }, { 12, 13, 11 } },
           VoxelBox{ { 5, 4, 5 }, { 11, 10, 12 } }, VoxelBox{ { 4, 5, 4 }, { 6, 8, 12 } } })
    {
      for (const bool isPeriodic : { false, true })
      {
        SCOPED_TRACE(testing::Message()
          << objects << ' ' << box.First[0] << ' ' << box.End[0] << ' ' << isPeriodic);
        const InterfaceScene scene(noise, box, isPeriodic);
        const InterfaceMesh mesh = StartOf(scene, { 1, 1, 1 });
        ExpectSound(mesh);
        const std::array<int, 6> counts = ExpectFlatSides(mesh, *scene.Fields);
        EXPECT_GT(*std::max_element(counts.begin(), counts.end()), 0);
        if (isPeriodic)
        {
          ExpectMatchingSides(mesh);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, InterfaceLatticeOfNoise, testing::Range(1, 4));

TEST(InterfaceLattice, IsCoarseWhereObjectsAreThick)
{
  EXPECT_EQ(PitchOf(FourBlocks(8)), (Pitches{ 2, 2, 2 }));
  EXPECT_EQ(PitchOf(FourBlocks(8), 0.7), (Pitches{ 1, 1, 1 })); // Shorter edges want more.
  LabelMap oblique = FourBlocks(8);
  oblique.Spacing = { 1., 1., 2. };
  EXPECT_EQ(PitchOf(oblique), (Pitches{ 2, 2, 1 }));
}

TEST(InterfaceLattice, IsFineWhereSomethingWouldBeLost)
{
  LabelMap map = FourBlocks(8);
  map.NumberOfObjects = 5;
  // A rod of a voxel, along voxels that are no points of the coarse lattice, nor beside any of it.
  for (int i = 5; i < 19; ++i)
  {
    map.Set(i, 12, 11, 5);
    map.Set(i, 12, 12, i % 2 == 0 ? 1 : 5);
  }
  const Pitches pitch = PitchOf(map);
  const InterfaceScene scene(map);
  const InterfaceMesh mesh =
    InterfaceLattice(*scene.Fields, EdgeOfVoxels, OnThisThread()).Start(OnThisThread());
  EXPECT_EQ(pitch, (Pitches{ 1, 1, 1 }));
  EXPECT_EQ(mesh.FindFacesOfObjects().size(), 6u);
  ExpectSound(mesh);
}

TEST(InterfaceLattice, DoesNotBridgeGapsOfAVoxel)
{
  // Along each axis, at voxels that are no points of the coarse lattice, and at those that are.
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int gap : { 11, 12 })
    {
      SCOPED_TRACE(10 * axis + gap);
      const InterfaceScene scene(MakeLabelMap({ 24, 24, 24 }, 2,
        [&](int i, int j, int k)
        {
          const std::array<int, 3> at = { i, j, k };
          const bool isIn = std::min({ i, j, k }) >= 4 && std::max({ i, j, k }) < 20;
          return !isIn || at[axis] == gap ? 0 : at[axis] < gap ? 1 : 2;
        }));
      const InterfaceLattice lattice(*scene.Fields, EdgeOfVoxels, OnThisThread());
      EXPECT_EQ(lattice.Pitch(), (Pitches{ 2, 2, 2 }));
      const InterfaceMesh mesh = lattice.Start(OnThisThread());
      ExpectSound(mesh);
      EXPECT_TRUE(mesh.FindLines().empty());
      EXPECT_EQ(mesh.FindFacesOfObjects().size(), 3u);
    }
  }
}

TEST(InterfaceFields, AreLargestWhereTheMapSaysSo)
{
  const InterfaceScene scene(ManyCells(28, 6, 5));
  ForVoxels({ 28, 28, 28 },
    [&](int i, int j, int k)
    { ASSERT_EQ(scene.Fields->LargestAt(i, j, k), scene.Map.At(i, j, k)) << i << j << k; });
}

TEST(InterfaceFields, MadeInPartsAreThoseMadeAsAWhole)
{
  const LabelMap map = ManyCells(56, 5, 3);
  const LabelBricks bricks(map, OnThisThread());
  const auto fieldsIn = [&](int partSize)
  {
    LabelFieldOptions options;
    options.PartSize = partSize;
    return InterfaceFields(
      bricks, options, map.Spacing, OnThisThread(), [](double) { return true; });
  };
  const InterfaceFields parts = fieldsIn(4);
  const InterfaceFields whole = fieldsIn(48);
  double furthest = 0.;
  for (int object = 0; object <= map.NumberOfObjects; ++object)
  {
    ForVoxels(map.Size(),
      [&](int i, int j, int k)
      {
        const float difference = parts.At(object, i, j, k) - whole.At(object, i, j, k);
        furthest = std::max(furthest, static_cast<double>(std::abs(difference)));
      });
  }
  EXPECT_LT(furthest, 0.002);
  EXPECT_GT(furthest, 0.); // Else none was made in parts.
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
                 scene.Fields->ValueAt(object, place - way * step)) /
          (2.f * step);
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
      [=](int i, int j, int k) {
        return std::min({ i, j, k }) >= 4 && std::max({ i, j, k }) < side - 4 ? 1 : 0;
      }));
    ForBox({ 2, 2, 2 }, { side - 2, side - 2, side - 2 },
      [&](int i, int j, int k)
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

TEST(InterfaceFields, ShiftNoFurtherThanFieldsReach)
{
  InterfaceScene scene(FourBlocks(5));
  const Vector place(6.f, 6.f, 6.f);
  const float before = scene.Fields->ValueAt(1, place);
  scene.Fields->Shift(1, 0.05f);
  EXPECT_NEAR(scene.Fields->ValueAt(1, place), before + 0.05f, 1e-5);
  scene.Fields->Shift(1, 9.f);
  EXPECT_LT(scene.Fields->ValueAt(1, place), before + LabelField::Far);
}

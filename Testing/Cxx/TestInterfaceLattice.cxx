// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceLattice.h"

#include "Core/Interfaces/LatticeCutter.h"
#include "Core/Labels/WrongVoxels.h"
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

INSTANTIATE_TEST_SUITE_P(Seeds, InterfaceLatticeOfNoise, testing::Range(1, 4));

TEST(InterfaceLattice, HasEachVoxelOnItsSide)
{
  const InterfaceScene scene(Noise(3, 4));
  const InterfaceMesh mesh = StartOf(scene, { 1, 1, 1 });
  const std::vector<std::vector<int>> faces = mesh.FindFacesOfObjects();
  for (int object = 1; object <= 3; ++object)
  {
    std::vector<int> vertices;
    const IndexedSurface surface =
      mesh.SurfaceOf(object, faces[static_cast<std::size_t>(object)], vertices);
    EXPECT_TRUE(FindWrongVoxels(*scene.Bricks, object, surface).empty()) << object;
  }
}

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
  const VoxelBox all = VoxelBox::Of(map.Size);
  for (int i = 5; i < 19; ++i)
  {
    map.Voxels[static_cast<std::size_t>(all.NumberOf(i, 12, 11))] = 5;
    map.Voxels[static_cast<std::size_t>(all.NumberOf(i, 12, 12))] = i % 2 == 0 ? 1 : 5;
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

TEST(InterfaceLattice, CutsFourBlocksWhereTheyMeet)
{
  const InterfaceScene scene(FourBlocks(6));
  const InterfaceMesh mesh = StartOf(scene, { 2, 2, 2 });
  ExpectSound(mesh);
  EXPECT_EQ(EulerCharacteristicOf(mesh), 4 * 2);
  int corners = 0;
  for (const Stratum stratum : mesh.StratumOf)
  {
    corners += stratum == Stratum::Corner ? 1 : 0;
  }
  EXPECT_GE(corners, 2); // Where the line between them ends at the outside.
}

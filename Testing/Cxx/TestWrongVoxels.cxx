// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/WrongVoxels.h"
#include "CoreTestTools.h"
#include "LabelTestTools.h"

using namespace volumic;

TEST(FindMissedVoxels, FindsThoseThatAreFurtherFromTheSurfaceInTheWorld)
{
  LabelMap map = MakeLabelMap({ 8, 8, 8 }, 1, [](int, int, int) { return 0; });
  map.Spacing = { 1., 1., 2. };
  IndexedSurface corner;
  corner.Points = { { 0., 0., 2.5 }, { 9., 0., 2.5 }, { 0., 9., 2.5 } };
  corner.Triangles = { { 0, 1, 2 } };
  const VoxelBox all = VoxelBox::Of(map.Size());
  const std::vector<std::int64_t> wrong = { all.NumberOf(2, 2, 1), all.NumberOf(2, 2, 2),
    all.NumberOf(2, 2, 3) };
  const std::vector<std::int64_t> furthest = { wrong[0] };
  EXPECT_EQ(FindMissedVoxels(map, wrong, corner, 0.), wrong);
  EXPECT_EQ(FindMissedVoxels(map, wrong, corner, 0.9), wrong);
  EXPECT_EQ(FindMissedVoxels(map, wrong, corner, 1.1), furthest);
  EXPECT_EQ(FindMissedVoxels(map, wrong, IndexedSurface(), 1.), wrong);
}

TEST(FindWrongVoxels, FindsThoseOutsideAndThoseInside)
{
  LabelMap map = MakeLabelMap({ 32, 32, 32 }, 1,
    [](int i, int j, int k) {
      return std::min({ i, j, k }) >= 8 && std::max({ i, j, k }) <= 20 ? 1 : 0;
    });
  const auto wrongOf = [&map](const IndexedSurface& surface) {
    return FindWrongVoxels(LabelBricks(map, OnThisThread()), 1, surface, VoxelBox::Of(map.Size()));
  };
  const IndexedSurface cube = Cuboid({ 7.5, 7.5, 7.5 }, { 20.5, 20.5, 20.5 });
  EXPECT_TRUE(wrongOf(cube).empty());
  const auto place = [&](int i, int j, int k)
  { return static_cast<std::size_t>(VoxelBox::Of(map.Size()).NumberOf(i, j, k)); };
  map.Set(15, 15, 15, 0);
  map.Set(15, 15, 27, 1);
  EXPECT_EQ(wrongOf(cube),
    (std::vector<std::int64_t>{ static_cast<std::int64_t>(place(15, 15, 15)),
      static_cast<std::int64_t>(place(15, 15, 27)) }));
  const std::vector<std::int64_t> all = wrongOf(IndexedSurface());
  EXPECT_EQ(
    static_cast<std::int64_t>(all.size()), LabelBricks(map, OnThisThread()).ExtentOf(1).Voxels)
    << "without a surface all are outside";
}

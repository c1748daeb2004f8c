// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Labels that are a voxel thin, by the judge that shares no code with the filter.
#include "JudgedLabels.h"

using namespace volumic::support;

namespace
{
/** A label map of one label. */
LabelMap MapOf(int size, const std::function<bool(int, int, int)>& isLabel)
{
  LabelMap map;
  map.Size = { size, size, size };
  for (int v = 0; v < size * size * size; ++v)
  {
    map.Values.push_back(isLabel(v % size, v / size % size, v / size / size) ? 1 : 0);
  }
  return map;
}

/** Thin labels of 32^3 voxels, by name. */
std::vector<std::pair<std::string, LabelMap>> ThinLabels()
{
  const auto along = [](int i) { return i >= 6 && i < 26; };
  const auto isRow = [&](int i, int j, int k) { return along(i) && j == 16 && k == 16; };
  const auto isPairs = [&](int i, int j, int k)
  { return along(i) && j == 16 && (k == 16 || k == 17); };
  const auto isDiagonal = [&](int i, int j, int k) { return along(i) && i == j && i == k; };
  const auto isStair = [&](int i, int j, int k)
  { return along(i) && ((i == j && (i == k || i + 1 == k)) || (i + 1 == j && i + 1 == k)); };
  const auto isPlate = [&](int i, int j, int k) { return along(i) && along(j) && k == 16; };
  const auto isTwo = [](int i, int j, int k) { return (i == 16 || i == 17) && j == 16 && k == 16; };
  return { { "row", MapOf(32, isRow) }, { "row of pairs", MapOf(32, isPairs) },
    { "diagonal of voxels", MapOf(32, isDiagonal) }, { "stair", MapOf(32, isStair) },
    { "plate", MapOf(32, isPlate) }, { "two voxels", MapOf(32, isTwo) } };
}
} // namespace

TEST(ThinLabels, HaveSurfacesByDefault)
{
  for (const auto& [name, map] : ThinLabels())
  {
    SCOPED_TRACE(name);
    const Filter filter = FilterOf(ToImage(map));
    vtkPolyData* block = BlockOf(filter);
    ASSERT_GT(block->GetNumberOfCells(), 0);
    EXPECT_LT(FieldOf(block, "WrongVoxels"), 0.25 * FieldOf(block, "LabelVoxels"));
  }
}

TEST(ThinLabels, LoseNoVoxelWithTheFinestTriangles)
{
  for (const auto& [name, map] : ThinLabels())
  {
    SCOPED_TRACE(name);
    const Filter filter = FilterOf(ToImage(map));
    filter->SetFinestLevel(-1);
    vtkPolyData* block = BlockOf(filter);
    const SurfaceVerdict verdict =
      JudgeSurface(ToTriangleSurface(block), FieldOf(block, "Delta"));
    EXPECT_TRUE(verdict.Topology.Closed && verdict.Topology.Outward);
    EXPECT_EQ(verdict.Intersections.Pairs, 0u);
    const WrongVoxelVerdict voxels = JudgeVoxels(ToTriangleSurface(block), map, 1);
    EXPECT_EQ(voxels.Wrong(), 0) << voxels.Outside << " outside, " << voxels.Inside << " inside";
  }
}

TEST(ThinLabels, StayWithAToleranceToo)
{
  for (const auto& [name, map] : ThinLabels())
  {
    SCOPED_TRACE(name);
    const Filter filter = FilterOf(ToImage(map));
    filter->SetVoxelTolerance(0.5);
    vtkPolyData* block = BlockOf(filter);
    ASSERT_GT(block->GetNumberOfCells(), 0);
    EXPECT_LE(FieldOf(block, "MissedVoxels"), 0.15 * FieldOf(block, "LabelVoxels"));
  }
}

// One that is lost on its way makes the triangles of its label smaller, not those of others.
TEST(ThinLabels, LeaveOtherLabelsAsTheyAre)
{
  const auto isBall = [](int i, int j, int k)
  { return std::hypot(i - 16.0, j - 8.0, k - 16.0) < 6.0; };
  const auto isTip = [](int i, int j, int k) { return i == 16 && j > 12 && j < 26 && k == 16; };
  const Filter ball = FilterOf(ToImage(MapOf(32, isBall)));
  const Filter both = FilterOf(ToImage(
    MapOf(32, [&](int i, int j, int k) { return isBall(i, j, k) || isTip(i, j, k); })));
  EXPECT_EQ(FieldOf(BlockOf(ball), "Level"), 0);
  EXPECT_EQ(FieldOf(BlockOf(both), "Level"), -1);
  EXPECT_LE(FieldOf(BlockOf(both), "WrongVoxels"), 2);
}

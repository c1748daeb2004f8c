// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/DrawBack.h"
#include "Core/Labels/TouchingSurfaces.h"
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
  LabelMap map = MakeLabelMap({ 32, 32, 32 }, 1, [](int i, int j, int k)
    { return std::min({ i, j, k }) >= 8 && std::max({ i, j, k }) <= 20 ? 1 : 0; });
  const IndexedSurface cube = Cuboid({ 7.5, 7.5, 7.5 }, { 20.5, 20.5, 20.5 });
  EXPECT_TRUE(FindWrongVoxels(LabelBricks(map, OnThisThread()), 1, cube).empty());
  const auto place = [&](int i, int j, int k)
  { return static_cast<std::size_t>(VoxelBox::Of(map.Size()).NumberOf(i, j, k)); };
  map.Set(15, 15, 15, 0);
  map.Set(15, 15, 27, 1);
  EXPECT_EQ(FindWrongVoxels(LabelBricks(map, OnThisThread()), 1, cube),
    (std::vector<std::int64_t>{ static_cast<std::int64_t>(place(15, 15, 15)),
      static_cast<std::int64_t>(place(15, 15, 27)) }));
  const std::vector<std::int64_t> all =
    FindWrongVoxels(LabelBricks(map, OnThisThread()), 1, IndexedSurface());
  EXPECT_EQ(static_cast<std::int64_t>(all.size()),
    LabelBricks(map, OnThisThread()).ExtentOf(1).Voxels)
    << "without a surface all are outside";
}

TEST(DrawBackWithin, LowersTheFieldWhereTheSurfaceLeavesItsInside)
{
  const LabelMap map = BallMap(32, 9.);
  const LabelField original =
    MakeLabelField(LabelBricks(map, OnThisThread()), 1, LabelFieldOptions(), OnThisThread());
  const Point middle = { 15.6, 15.6, 15.6 };
  LabelField field = original;
  EXPECT_FALSE(
    DrawBackWithin(original, DividedIcosahedron(middle, 8.2, 1.), 0.3f, field));
  EXPECT_EQ(field.Values, original.Values);
  IndexedSurface sphere = DividedIcosahedron(middle, 8.2, 1.);
  for (Point& p : sphere.Points)
  {
    p[2] += p[2] > 23. ? 1.5 : 0.; // A bump that leaves the ball.
  }
  EXPECT_TRUE(DrawBackWithin(original, sphere, 0.3f, field));
  EXPECT_NEAR(ValueAt(field, 15, 15, 25), ValueAt(original, 15, 15, 25) - 0.3f, 1e-5);
  EXPECT_EQ(ValueAt(field, 15, 15, 7), ValueAt(original, 15, 15, 7)) << "the other side stays";
}

TEST(DrawBackWithin, LooksAtTrianglesBetweenTheirCorners)
{
  const LabelMap map = MakeLabelMap({ 40, 20, 20 }, 1, [](int i, int j, int k)
    { return std::hypot(std::abs(i - 19.5) - 11., j - 9.6, k - 9.6) < 6. ? 1 : 0; });
  const LabelField original =
    MakeLabelField(LabelBricks(map, OnThisThread()), 1, LabelFieldOptions(), OnThisThread());
  LabelField field = original;
  IndexedSurface triangle;
  triangle.Points = { { 8.5, 8., 9. }, { 8.5, 11., 9. }, { 30.5, 9.6, 9. } };
  triangle.Triangles = { { 0, 1, 2 } };
  EXPECT_TRUE(DrawBackWithin(original, triangle, 0.3f, field)) << "it crosses the space between";
}

TEST(SizeOfLargestLostPart, CountsVoxelsThatShareFacesButNotThoseBesideWhatIsKept)
{
  // A block with a rod of 7 voxels on it, a row of 3 around a corner, and one by an edge of that.
  const auto isObject = [](int i, int j, int k)
  {
    const bool isRod = i >= 4 && i < 11 && j == 3 && k == 3;
    const bool isRow = k == 8 && ((j == 3 && (i == 6 || i == 7)) || (j == 4 && i == 7));
    return i < 4 || isRod || isRow || (i == 8 && j == 5 && k == 8);
  };
  const LabelMap map = MakeLabelMap({ 12, 12, 12 }, 2,
    [&](int i, int j, int k) { return isObject(i, j, k) ? 1 : i == 11 ? 2 : 0; });
  const auto lost = [&](const std::function<bool(int, int, int)>& isWrong)
  {
    std::vector<std::int64_t> wrong;
    for (int v = 0; v < 12 * 12 * 12; ++v)
    {
      if (isWrong(v % 12, v / 12 % 12, v / 144))
      {
        wrong.push_back(v);
      }
    }
    return SizeOfLargestLostPart(map, 1, wrong);
  };
  EXPECT_EQ(lost([](int, int, int) { return false; }), 0);
  EXPECT_EQ(lost([](int i, int, int) { return i == 11; }), 0) << "another object's, inside";
  EXPECT_EQ(lost([](int i, int, int) { return i > 3; }), 6) << "but for the voxel on the block";
  EXPECT_EQ(lost([](int i, int, int k) { return i > 3 && k == 8; }), 3);
  EXPECT_EQ(lost([](int i, int j, int) { return i == 3 && j == 3; }), 0) << "a ridge";
}

namespace
{
/** About (x, 10, 10). */
IndexedSurface OctahedronAt(double x, double radius)
{
  IndexedSurface made;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double side : { -radius, radius })
    {
      Point p = { x, 10., 10. };
      p[axis] += side;
      made.Points.push_back(p);
    }
  }
  made.Triangles = { { 1, 3, 5 }, { 3, 0, 5 }, { 0, 2, 5 }, { 2, 1, 5 }, { 3, 1, 4 }, { 0, 3, 4 },
    { 2, 0, 4 }, { 1, 2, 4 } };
  return made;
}

IndexedSurface JoinedWith(IndexedSurface first, const IndexedSurface& second)
{
  const int count = static_cast<int>(first.Points.size());
  for (const Point& p : second.Points)
  {
    first.Points.push_back(p);
  }
  for (const Triangle& t : second.Triangles)
  {
    first.Triangles.push_back({ t[0] + count, t[1] + count, t[2] + count });
  }
  return first;
}

using Meetings = std::vector<std::vector<SurfaceTriangle>>;

std::vector<SurfaceTriangle> TrianglesOf(std::size_t surface, const std::vector<int>& triangles)
{
  std::vector<SurfaceTriangle> made;
  for (const int t : triangles)
  {
    made.push_back({ surface, t });
  }
  return made;
}
}

TEST(FindTouching, NamesTheTrianglesOfBothThatMeet)
{
  const Meetings touching = FindTouching(
    { OctahedronAt(5., 3.), OctahedronAt(10.5, 3.), OctahedronAt(30., 3.) }, OnThisThread());
  ASSERT_EQ(touching.size(), 3u);
  EXPECT_EQ(touching[0], TrianglesOf(0, { 0, 3, 4, 7 })) << "all about the corner at larger x";
  EXPECT_EQ(touching[1], TrianglesOf(1, { 1, 2, 5, 6 }));
  EXPECT_TRUE(touching[2].empty());
}

TEST(FindTouching, TouchingInAPointCounts)
{
  const auto meet = [](const IndexedSurface& a, const IndexedSurface& b)
  { return !FindTouching({ a, b }, OnThisThread())[0].empty(); };
  EXPECT_TRUE(meet(OctahedronAt(5., 3.), OctahedronAt(11., 3.)));
  EXPECT_FALSE(meet(OctahedronAt(5., 3.), OctahedronAt(11.01, 3.)));
  EXPECT_FALSE(meet(OctahedronAt(5., 3.), IndexedSurface()));
}

TEST(FindTouching, NamesAllOfAComponentWithinAnotherSurfaceForThatUnlessItIsInACavity)
{
  // Of the second surface one component is within the first, the other apart.
  const IndexedSurface apart = JoinedWith(OctahedronAt(30., 3.), OctahedronAt(5., 1.));
  const Meetings meetings = FindTouching({ OctahedronAt(5., 3.), apart }, OnThisThread());
  EXPECT_EQ(meetings[0], TrianglesOf(1, { 8, 9, 10, 11, 12, 13, 14, 15 }));
  EXPECT_TRUE(meetings[1].empty());
  IndexedSurface cavity = OctahedronAt(5., 2.);
  for (Triangle& t : cavity.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  const IndexedSurface shell = JoinedWith(OctahedronAt(5., 3.), cavity);
  for (const auto& ofOne : FindTouching({ shell, OctahedronAt(5., 1.) }, OnThisThread()))
  {
    EXPECT_TRUE(ofOne.empty());
  }
}

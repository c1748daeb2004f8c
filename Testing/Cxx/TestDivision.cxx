// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Mesh/Division.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
void LimitValence(KeptEdges& kept)
{
  for (auto full = kept.FindOverfull(); !full.empty(); full = kept.FindOverfull())
  {
    for (const int v : full)
    {
      kept.KeepAllAt(v);
    }
  }
}
}

TEST(Division, IsIndependentOfThreads)
{
  // More faces than one task processes.
  SurfaceMesh old = MakeSphere({ 0, 0, 0 }, 20, 0.5);
  old.Reorder(SpaceFillingOrder(old, 1.)); // Otherwise all faces belong to the first vertices.
  ASSERT_GT(old.NumberOfFaces(), 20000);
  KeptEdges kept(old);
  for (int v = 0; v < old.Size(); v += 7)
  {
    kept.Keep(v, old.Rings[v].Item[0]);
  }
  Executor threads(3);
  const IndexedSurface divided = Divide(old, &kept, threads).ToIndexed();
  const IndexedSurface alone = Divide(old, &kept).ToIndexed();
  EXPECT_EQ(divided.Points, alone.Points);
  EXPECT_EQ(divided.Triangles, alone.Triangles);
}

TEST(Division, YieldsValidMeshForAnyKeptEdges)
{
  std::mt19937 engine(7);
  for (int tenths : { 1, 5, 9 })
  {
    const SurfaceMesh copy = MakeSphere({ 0, 0, 0 }, 10, 3);
    KeptEdges kept(copy);
    int edges = 0;
    for (int v = 0; v < copy.Size(); ++v)
    {
      for (int i = 0; i < copy.Rings[v].Count; ++i)
      {
        const int w = copy.Rings[v].Item[i];
        if (v < w && static_cast<int>(engine() % 10) < tenths)
        {
          kept.Keep(v, w);
          ++edges;
        }
      }
    }
    LimitValence(kept);
    const SurfaceMesh mesh = Divide(copy, &kept);
    ExpectValidMesh(mesh.ToIndexed());
    EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
    EXPECT_GE(mesh.Size(), copy.Size() + copy.NumberOfFaces() + edges);
  }
}

TEST(Division, LimitsValenceWithKeptEdges)
{
  // Both tips of a double cone have 15 neighbours. Every other edge kept would give 22.
  constexpr int sides = Ring::Capacity;
  const SurfaceMesh copy = MeshOf(DoubleCone(sides));
  KeptEdges kept(copy);
  for (int i = 0; i < sides; i += 2)
  {
    kept.Keep(0, 2 + i);
  }
  EXPECT_EQ(kept.FindOverfull(), std::vector<int>({ 0 }));
  LimitValence(kept);
  const SurfaceMesh mesh = Divide(copy, &kept);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.Rings[0].Count, sides);
}

namespace
{
/**
 * Divide by an evolution, with edges of `unit`, a surface that a plain division makes intersect
 * itself.
 */
SurfaceResult DivideWithin(const IndexedSurface& given, double unit)
{
  EXPECT_GT(CountSelfIntersections(Divide(MeshOf(given)).ToIndexed()), 0)
    << "the test requires an intersection";

  const TestVolume volume = BallVolume(16, 4.);
  SurfaceOptions options = IsoHalf();
  options.SamplingRatio = 1.;
  options.RecoverMissedParts = false;
  options.SnapToIsoValue = false; // Otherwise the surface is moved before it is divided.
  TestEvolution evolution(options, Threads, Silent);
  evolution.StartSurface(volume.Image, 1, given);
  EXPECT_EQ(evolution.Result().Points.size(), given.Points.size())
    << "the start must not change the surface";
  LevelImage fine = volume.Image;
  fine.Unit = unit;
  evolution.Divide(fine, 0);
  return evolution.Result();
}
}

TEST(Division, PreservesGapBetweenComponents)
{
  // The division cuts off the edges of an icosahedron. A small cavity inside has a corner just
  // below the midpoint of such an edge. A plain division would make the surfaces intersect.
  IndexedSurface given = Icosahedron({ 8, 8, 8 }, 2.37);
  VectorD up;
  for (const int corner : { given.Triangles[0][0], given.Triangles[0][1] })
  {
    const Point& p = given.Points[corner];
    up += VectorD(p[0] - 8, p[1] - 8, p[2] - 8);
  }
  up = Normalized(up);
  IndexedSurface inner = Icosahedron({ 0, 0, 0 }, 0.96);
  // Rotate it so that its first corner points up.
  const Point& c = inner.Points[0];
  const VectorD half = Normalized(Normalized(VectorD(c[0], c[1], c[2])) + up);
  for (Point& point : inner.Points)
  {
    const VectorD p(point[0], point[1], point[2]);
    const VectorD turned = half * (2 * Dot(half, p)) - p + up * 0.94;
    point = { 8 + turned.X, 8 + turned.Y, 8 + turned.Z };
  }
  AddSurface(given, InsideOut(inner));
  ASSERT_EQ(CountSelfIntersections(given), 0);
  // One division, and two in a row. The first of these leaves edges longer than those of the last
  // level.
  for (double unit : { 1. / std::sqrt(3.), 1. / 3. })
  {
    const SurfaceResult divided = DivideWithin(given, unit);
    ExpectValidMesh(divided);
    EXPECT_EQ(ComputeFeatures(divided).Components.size(), 2u);
    ExpectEdgesWithin(divided, 0., 2.5001 * divided.Delta);
  }
}

TEST(Division, SearchRadiusCoversLongEdges)
{
  // A body with a groove, which the division fills, and a blade in the groove. They intersect at
  // the midpoints of edges, far from all corners in the unit of the last of five divisions.
  IndexedSurface given;
  given.Points = { { 5.9, 8, 8.6 }, { 10.1, 8, 8.6 }, { 8, 6.8, 8 }, { 8, 9.2, 8 }, { 8, 8, 7.3 },
    { 8, 7.13, 8.1 }, { 8, 8.87, 8.1 }, { 8.51, 8, 8.253 }, { 7.49, 8, 8.253 } };
  given.Triangles = { { 0, 2, 3 }, { 1, 3, 2 }, { 0, 4, 2 }, { 2, 4, 1 }, { 1, 4, 3 }, { 3, 4, 0 },
    { 5, 6, 7 }, { 6, 5, 8 }, { 5, 7, 8 }, { 6, 8, 7 } };
  ASSERT_EQ(CountSelfIntersections(given), 0);
  const SurfaceResult divided = DivideWithin(given, std::pow(3., -2.5));
  EXPECT_EQ(CountSelfIntersections(divided), 0);
  for (const Point& old : given.Points)
  {
    double nearest = 1e9;
    for (const Point& p : divided.Points)
    {
      nearest = std::min(nearest, Distance(p[0], p[1], p[2], old[0], old[1], old[2]));
    }
    EXPECT_LT(nearest, 1e-5) << "the division must not fall back to remeshing";
  }
}

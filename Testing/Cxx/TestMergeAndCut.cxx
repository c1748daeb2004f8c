// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
int Nearest(const SurfaceMesh& mesh, const Vector& place, int from, int to)
{
  int best = from;
  for (int v = from; v < to; ++v)
  {
    if (SquaredDistance(mesh.Position[v], place) < SquaredDistance(mesh.Position[best], place))
    {
      best = v;
    }
  }
  return best;
}
}

TEST(StarMerge, JoinsTwoSpheres)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int second = mesh.Append(DividedIcosahedron({ 7, 0, 0 }, 3, 1));
  ASSERT_EQ(mesh.CountEulerCharacteristic(), 4);
  StarMerge merge;
  merge.U = Nearest(mesh, Vector(3, 0, 0), 0, second);
  merge.V = Nearest(mesh, Vector(4, 0, 0), second, mesh.Size());
  ASSERT_TRUE(merge.Plan(mesh));
  const std::size_t rims = mesh.Rings[merge.U].Count + mesh.Rings[merge.V].Count;
  EXPECT_EQ(merge.Strip().size(), rims);
  merge.Apply(mesh);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
  const SurfaceFeatures features = ComputeFeatures(mesh.ToIndexed());
  EXPECT_EQ(features.Components.size(), 1u);
  EXPECT_EQ(features.Genus, 0);
  EXPECT_EQ(CountSelfIntersections(mesh.ToIndexed()), 0);
}

TEST(StarMerge, RefusesRimsThatTouch)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  StarMerge merge;
  merge.U = 20;
  merge.V = mesh.Rings[20].Item[0];
  EXPECT_FALSE(merge.Plan(mesh));
  merge.V = mesh.Rings[merge.V].Item[0];
  EXPECT_FALSE(merge.Plan(mesh));
}

TEST(StarMerge, MakesAManifoldOfAnyTwoStars)
{
  // Far and skew pairs tempt the strip into staying on one vertex for a whole turn.
  for (int i = 0; i < 60; ++i)
  {
    SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
    const Point centre = { 5. + i % 7, 1. * (i % 5), 1. * (i % 3) };
    const int second = mesh.Append(DividedIcosahedron(centre, 1.5, 0.9));
    StarMerge merge;
    merge.U = i % second;
    merge.V = second + (i * 7) % (mesh.Size() - second);
    ASSERT_TRUE(merge.Plan(mesh));
    merge.Apply(mesh);
    ASSERT_EQ(DescribeBrokenInvariant(mesh), "") << "pair " << i;
    ASSERT_EQ(mesh.CountEulerCharacteristic(), 2);
  }
}

TEST(StarMerge, TakesTheShortestBridgeEdges)
{
  // Mirror images of each other: every vertex of a rim has its own across.
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  IndexedSurface mirrored = mesh.ToIndexed();
  for (Point& p : mirrored.Points)
  {
    p[0] = 7 - p[0];
  }
  for (Triangle& t : mirrored.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  const int second = mesh.Append(mirrored);
  StarMerge merge;
  merge.U = Nearest(mesh, Vector(3, 0, 0), 0, second);
  merge.V = merge.U + second;
  ASSERT_TRUE(merge.Plan(mesh));
  const Ring rim = mesh.Rings[merge.U];
  double longest = 0;
  double shortest = 1e9;
  for (int i = 0; i < rim.Count; ++i)
  {
    longest = std::max(longest, 7. - 2 * mesh.Position[rim.Item[i]].X);
    shortest = std::min(shortest, 7. - 2 * mesh.Position[rim.Item[i]].X);
  }
  merge.Apply(mesh);
  double diagonal = 0;
  for (int i = 0; i < rim.Count; ++i)
  {
    EXPECT_TRUE(mesh.AreNeighbours(rim.Item[i], rim.Item[i] + second)) << "straight across";
    for (int k : { rim.Item[i] + second, rim.Next(i) + second, rim.Previous(i) + second })
    {
      if (mesh.AreNeighbours(rim.Item[i], k))
      {
        diagonal = std::max(diagonal,
          static_cast<double>(SquaredDistance(mesh.Position[rim.Item[i]], mesh.Position[k])));
      }
    }
  }
  EXPECT_GT(shortest, 0.9);
  EXPECT_GE(merge.SquaredLongestBridgeEdge(), longest * longest - 1e-4);
  EXPECT_NEAR(merge.SquaredLongestBridgeEdge(), diagonal, 1e-4);
}

TEST(StarMerge, RefusesABandThatWouldOverfillARing)
{
  // Each vertex of the belt of a double cone of three sides has four neighbours; the rim of a tip
  // of fifteen sides hands five bridge edges to each.
  const auto cone = [](double z, int sides, int crowded)
  {
    IndexedSurface surface;
    surface.Points = { { 0, 0, z + 1 }, { 0, 0, z - 1 } };
    for (int i = 0; i < sides; ++i)
    {
      const double a = 2 * 3.14159265358979 * i / sides;
      surface.Points.push_back({ 3 * std::cos(a), 3 * std::sin(a), z });
    }
    for (int i = 0; i < sides; ++i)
    {
      const int next = 2 + (i + 1) % sides;
      surface.Triangles.push_back({ 0, 2 + i, next });
      if (i != 0)
      {
        surface.Triangles.push_back({ 1, next, 2 + i });
        continue;
      }
      // About the first side vertices are strung, so that its end has more neighbours.
      int last = 2;
      for (int k = 0; k < crowded; ++k)
      {
        const double share = (k + 1.) / (crowded + 1);
        const int added = static_cast<int>(surface.Points.size());
        surface.Points.push_back({ 2.9 * share, 0, z - 0.9 + 0.5 * share });
        surface.Triangles.push_back({ next, last, added });
        surface.Triangles.push_back({ 1, added, last });
        last = added;
      }
      surface.Triangles.push_back({ 1, next, last });
    }
    return surface;
  };
  for (const int crowded : { 0, 9 })
  {
    SurfaceMesh mesh;
    const IndexedSurface lower = cone(0, 3, crowded);
    const int second = mesh.Append(lower);
    ASSERT_EQ(second, 0);
    const int upper = mesh.Append(cone(3, 15, 0));
    StarMerge merge;
    merge.U = 0;
    merge.V = upper + 1;
    EXPECT_EQ(merge.Plan(mesh), crowded == 0) << crowded;
  }
}

TEST(CycleCut, SplitsADoublePyramid)
{
  SurfaceMesh mesh;
  mesh.Append({ { { 1, 0, 0 }, { -1, 1, 0 }, { -1, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } },
    { { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 }, { 1, 0, 4 }, { 2, 1, 4 }, { 0, 2, 4 } } });
  const CycleCut cut{ 0, 1, 2 };
  ASSERT_TRUE(cut.IsLegal(mesh));
  cut.Apply(mesh);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 4);
  const SurfaceFeatures features = ComputeFeatures(mesh.ToIndexed());
  EXPECT_EQ(features.Components.size(), 2u);
  EXPECT_NEAR(features.Components[0].Volume, features.Components[1].Volume, 1e-6);
}

TEST(CycleCut, RefusesAFace)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int b = mesh.Rings[5].Item[0];
  const int c = mesh.Rings[5].Item[1];
  EXPECT_FALSE((CycleCut{ 5, b, c }).IsLegal(mesh));
  EXPECT_FALSE((CycleCut{ 5, c, b }).IsLegal(mesh));
}

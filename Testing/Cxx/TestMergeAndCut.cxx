// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "CycleCut.h"
#include "StarMerge.h"

#include <gtest/gtest.h>

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
  EXPECT_EQ(merge.Band().size(), rims);
  merge.Apply(mesh);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
  const SurfaceFeatures features = ComputeFeatures(mesh.ToIndexed());
  EXPECT_EQ(features.Components.size(), 1u);
  EXPECT_EQ(features.Genus, 0);
  EXPECT_EQ(CountSelfIntersections(mesh.ToIndexed()), 0);
}

TEST(StarMerge, GivesASphereAHandle)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  StarMerge merge;
  merge.U = Nearest(mesh, Vector(3, 0, 0), 0, mesh.Size());
  merge.V = Nearest(mesh, Vector(-3, 0, 0), 0, mesh.Size());
  ASSERT_TRUE(merge.Plan(mesh));
  merge.Apply(mesh);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 0);
  EXPECT_EQ(ComputeFeatures(mesh.ToIndexed()).Genus, 1);
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
  // Far and skew pairs tempt the band into staying on one vertex for a whole turn.
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

TEST(CycleCut, TakesTheHandleOfATorus)
{
  // A torus with a tube of three vertices: each ring of the tube is a 3-cycle.
  SurfaceMesh mesh;
  mesh.Append(MakeTorus({ 0, 0, 0 }, 5, 1, 16, 3));
  ASSERT_EQ(mesh.CountEulerCharacteristic(), 0);
  const CycleCut cut{ 0, 1, 2 };
  ASSERT_TRUE(cut.IsLegal(mesh));
  cut.Apply(mesh);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
  EXPECT_EQ(ComputeFeatures(mesh.ToIndexed()).Components.size(), 1u);
}

TEST(CycleCut, RefusesAFace)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int b = mesh.Rings[5].Item[0];
  const int c = mesh.Rings[5].Item[1];
  EXPECT_FALSE((CycleCut{ 5, b, c }).IsLegal(mesh));
  EXPECT_FALSE((CycleCut{ 5, c, b }).IsLegal(mesh));
}

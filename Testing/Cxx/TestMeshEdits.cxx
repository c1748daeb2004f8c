// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "EdgeCollapse.h"
#include "EdgeFlip.h"
#include "EdgeSplit.h"
#include "VertexRemoval.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace volumic;

namespace
{
SurfaceMesh Tetrahedron()
{
  SurfaceMesh mesh;
  mesh.Append({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } } });
  return mesh;
}

#define EXPECT_SOUND(mesh, chi)                                                                    \
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");                                                    \
  EXPECT_EQ((mesh).CountEulerCharacteristic(), chi)
}

TEST(SurfaceMesh, KeepsTheTrianglesItWasMadeOf)
{
  const IndexedSurface torus = MakeTorus({ 0, 0, 0 }, 5, 2, 20, 10);
  SurfaceMesh mesh;
  mesh.Append(torus);
  EXPECT_SOUND(mesh, 0);
  const IndexedSurface back = mesh.ToIndexed();
  EXPECT_EQ(back.Points.size(), torus.Points.size());
  EXPECT_EQ(back.Triangles.size(), torus.Triangles.size());
  EXPECT_NEAR(ComputeFeatures(back).Volume, ComputeFeatures(torus).Volume, 1e-3);
}

TEST(SurfaceMesh, KeepsItsShapeWhenRenumbered)
{
  SurfaceMesh mesh = MakeSphere({ 5, 5, 5 }, 4, 0.8);
  const double volume = ComputeFeatures(mesh.ToIndexed()).Volume;
  mesh.Reorder(SpaceFillingOrder(mesh, 1.));
  EXPECT_SOUND(mesh, 2);
  EXPECT_NEAR(ComputeFeatures(mesh.ToIndexed()).Volume, volume, 1e-3);
}

TEST(SurfaceMeshInvalid, RefusesAnOpenSurface)
{
  IndexedSurface open = Icosahedron({ 0, 0, 0 }, 1);
  open.Triangles.pop_back();
  SurfaceMesh mesh;
  EXPECT_THROW(mesh.Append(open), std::invalid_argument);
}

TEST(SurfaceMeshInvalid, RefusesATwistedSurface)
{
  IndexedSurface twisted = Icosahedron({ 0, 0, 0 }, 1);
  std::swap(twisted.Triangles[3][0], twisted.Triangles[3][1]);
  SurfaceMesh mesh;
  EXPECT_THROW(mesh.Append(twisted), std::invalid_argument);
}

TEST(EdgeFlip, JoinsTheOppositeVertices)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const int u = 20;
  const int v = mesh.Rings[u].Item[2];
  const EdgeFlip flip = EdgeFlip::Of(mesh, u, v);
  ASSERT_TRUE(flip.IsLegal(mesh));
  flip.Apply(mesh);
  EXPECT_FALSE(mesh.AreNeighbours(u, v));
  EXPECT_TRUE(mesh.AreNeighbours(flip.A, flip.B));
  EXPECT_SOUND(mesh, 2);
}

TEST(EdgeFlip, FlippedTwiceIsTheSameMesh)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const int u = 7;
  const int v = mesh.Rings[u].Item[0];
  const EdgeFlip flip = EdgeFlip::Of(mesh, u, v);
  flip.Apply(mesh);
  EdgeFlip::Of(mesh, flip.A, flip.B).Apply(mesh);
  EXPECT_TRUE(mesh.AreNeighbours(u, v));
  EXPECT_SOUND(mesh, 2);
}

TEST(EdgeFlip, IsIllegalOnATetrahedron)
{
  const SurfaceMesh mesh = Tetrahedron();
  EXPECT_FALSE(EdgeFlip::Of(mesh, 0, 1).IsLegal(mesh));
}

TEST(EdgeSplit, AddsAVertexOfValenceFourAndKeepsTheSurface)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const double volume = ComputeFeatures(mesh.ToIndexed()).Volume;
  const int v = mesh.Rings[3].Item[1];
  const EdgeSplit split{ 3, v };
  ASSERT_TRUE(split.IsLegal(mesh));
  const int m = split.Apply(mesh, (mesh.Position[3] + mesh.Position[v]) * 0.5f);
  EXPECT_EQ(mesh.Rings[m].Count, 4);
  EXPECT_SOUND(mesh, 2);
  EXPECT_NEAR(ComputeFeatures(mesh.ToIndexed()).Volume, volume, 1e-4);
}

TEST(EdgeCollapse, TakesAVertexAndTwoFaces)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const int vertices = mesh.NumberOfVertices();
  const int faces = mesh.NumberOfFaces();
  const EdgeCollapse collapse{ 30, mesh.Rings[30].Item[0] };
  ASSERT_TRUE(collapse.IsLegal(mesh));
  collapse.Apply(mesh);
  EXPECT_EQ(mesh.NumberOfVertices(), vertices - 1);
  EXPECT_EQ(mesh.NumberOfFaces(), faces - 2);
  EXPECT_SOUND(mesh, 2);
}

TEST(EdgeCollapse, UndoesASplit)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const int v = mesh.Rings[3].Item[1];
  const int m = EdgeSplit{ 3, v }.Apply(mesh, Vector(0, 0, 0));
  const EdgeCollapse collapse{ 3, m };
  ASSERT_TRUE(collapse.IsLegal(mesh));
  collapse.Apply(mesh);
  EXPECT_TRUE(mesh.AreNeighbours(3, v));
  EXPECT_SOUND(mesh, 2);
}

TEST(EdgeCollapse, IsBlockedByAThirdCommonNeighbour)
{
  // Two tetrahedra on a common triangle: 0, 1, 2 are pairwise neighbours but bound no face.
  SurfaceMesh mesh;
  mesh.Append({ { { 1, 0, 0 }, { -1, 1, 0 }, { -1, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } },
    { { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 }, { 1, 0, 4 }, { 2, 1, 4 }, { 0, 2, 4 } } });
  const EdgeCollapse collapse{ 0, 1 };
  EXPECT_EQ(collapse.ThirdCommonNeighbour(mesh), 2);
  EXPECT_FALSE(collapse.IsLegal(mesh));
}

TEST(VertexRemoval, TakesWhatWasSetIntoAFace)
{
  // A split beside a vertex of valence 3 in the making: collapse until one has three neighbours.
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 2, 0.5);
  const int u = 3;
  const int v = mesh.Rings[u].Item[1];
  const int m = EdgeSplit{ u, v }.Apply(mesh, Vector(0, 0, 0));
  // Flipping one of the four edges of m leaves three.
  const EdgeFlip flip = EdgeFlip::Of(mesh, m, u);
  ASSERT_TRUE(flip.IsLegal(mesh));
  flip.Apply(mesh);
  ASSERT_EQ(mesh.Rings[m].Count, 3);
  const VertexRemoval removal{ m };
  ASSERT_TRUE(removal.IsLegal(mesh));
  removal.Apply(mesh);
  EXPECT_SOUND(mesh, 2);
}

TEST(VertexRemoval, IsIllegalOnATetrahedron)
{
  EXPECT_FALSE(VertexRemoval{ 0 }.IsLegal(Tetrahedron()));
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "Division.h"

#include <gtest/gtest.h>

using namespace volumic;

namespace
{
double MeanEdge(const SurfaceMesh& mesh)
{
  double sum = 0;
  long count = 0;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    for (int i = 0; i < mesh.Rings[v].Count; ++i, ++count)
    {
      sum += Length(mesh.Position[mesh.Rings[v].Item[i]] - mesh.Position[v]);
    }
  }
  return sum / static_cast<double>(count);
}
}

TEST(Division, MakesThreeTimesTheFacesWithEdgesShorterBySqrtThree)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 10, 1.5);
  const int vertices = mesh.NumberOfVertices();
  const int faces = mesh.NumberOfFaces();
  const double edge = MeanEdge(mesh);
  const int first = Divide(mesh);
  EXPECT_EQ(first, vertices);
  EXPECT_EQ(mesh.NumberOfVertices(), vertices + faces);
  EXPECT_EQ(mesh.NumberOfFaces(), 3 * faces);
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_NEAR(edge / MeanEdge(mesh), std::sqrt(3.), 0.03);
}

TEST(Division, KeepsOldValencesAndGivesNewVerticesSix)
{
  SurfaceMesh mesh;
  mesh.Append(MakeTorus({ 0, 0, 0 }, 5, 2, 17, 9));
  mesh.Append(Icosahedron({ 20, 0, 0 }, 3));
  const std::vector<Ring> old = mesh.Rings;
  const int first = Divide(mesh);
  for (int v = 0; v < mesh.Size(); ++v)
  {
    EXPECT_EQ(mesh.Rings[v].Count, v < first ? old[v].Count : 6);
  }
  EXPECT_EQ(DescribeBrokenInvariant(mesh), "");
  EXPECT_EQ(mesh.CountEulerCharacteristic(), 2);
}

TEST(Division, DoesNotIntersectOnASmoothSurface)
{
  SurfaceMesh mesh;
  mesh.Append(MakeTorus({ 0, 0, 0 }, 5, 2, 30, 15));
  Divide(mesh);
  EXPECT_EQ(CountSelfIntersections(mesh.ToIndexed()), 0);
}

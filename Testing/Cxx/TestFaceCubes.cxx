// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/FaceCubes.h"

#include "Core/Interfaces/InterfaceStart.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "InterfaceTestTools.h"
#include "ThreadTestTools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

using namespace volumic;

namespace
{
InterfaceMesh StartOf(const InterfaceScene& scene)
{
  return StartInterfaces(*scene.Fields, OnThisThread());
}

/** After collapses and flips. */
InterfaceMesh Edited(InterfaceMesh mesh, Executor& executor)
{
  InterfaceRemesher remesher(mesh, 1.1, 1.8, 1e-3, executor, [] { return true; });
  EXPECT_GT(remesher.CollapseShortEdges(), 1000);
  EXPECT_GT(remesher.FlipEdges(), 100);
  return mesh;
}

void ExpectSame(const InterfaceMesh& a, const InterfaceMesh& b)
{
  ASSERT_EQ(a.Position.size(), b.Position.size());
  ASSERT_EQ(a.Faces.size(), b.Faces.size());
  std::size_t others = 0;
  for (std::size_t v = 0; v < a.Position.size(); ++v)
  {
    others += a.IsVertex(static_cast<int>(v)) != b.IsVertex(static_cast<int>(v)) ||
        SquaredDistance(a.Position[v], b.Position[v]) > 0.f
      ? 1
      : 0;
  }
  for (std::size_t f = 0; f < a.Faces.size(); ++f)
  {
    others += a.Faces[f].Vertex != b.Faces[f].Vertex ? 1 : 0;
  }
  EXPECT_EQ(others, 0u);
}
}

TEST(FaceCubes, HaveEachFaceOnceWhereItsMiddleIs)
{
  const InterfaceScene scene(ManyCells(30, 12, 1));
  InterfaceMesh mesh = StartOf(scene);
  mesh.RemoveFace(7);
  InterfaceClearance clearance(mesh, 1e-3);
  clearance.Reset(OnThisThread());
  constexpr float side = 5.f;
  const FaceCubes cubes(mesh, clearance, side, OnThisThread());
  std::vector<int> all = cubes.Faces;
  std::sort(all.begin(), all.end());
  std::vector<int> wanted(mesh.Faces.size());
  std::iota(wanted.begin(), wanted.end(), 0);
  wanted.erase(wanted.begin() + 7);
  EXPECT_EQ(all, wanted);
  for (const std::vector<FaceCubes::Cube>& colour : cubes.OfColour)
  {
    EXPECT_GT(colour.size(), 4u);
    for (const FaceCubes::Cube& cube : colour)
    {
      for (std::size_t n = cube.First; n < cube.Last; ++n)
      {
        const Vector middle = clearance.BoxOf(cubes.Faces[n]).Middle();
        EXPECT_LE(Length(middle - cube.Box.Middle()), 0.5001f * side * std::sqrt(3.f));
        EXPECT_TRUE(n == cube.First || cubes.Faces[n - 1] < cubes.Faces[n]);
      }
      // Between two of a colour there is another one.
      for (const FaceCubes::Cube& other : colour)
      {
        const Vector way = other.Box.Low - cube.Box.Low;
        EXPECT_TRUE(&other == &cube ||
          std::max({ std::abs(way.X), std::abs(way.Y), std::abs(way.Z) }) > 1.99f * side);
      }
    }
  }
}

TEST(InterfaceRemesher, MakesTheSameEditsInAnyOrderOfCubes)
{
  const InterfaceScene scene(ManyCells(64, 60, 2));
  const InterfaceMesh start = StartOf(scene);
  const InterfaceMesh forward = Edited(start, OnThisThread());
  ExpectSound(forward);
  ScrambledExecutor backward(1);
  ExpectSame(Edited(start, backward), forward);
  Executor threads(3);
  ExpectSame(Edited(start, threads), forward);
}

TEST(InterfaceRemesher, StopsBetweenCubes)
{
  const InterfaceScene scene(ManyCells(30, 12, 1));
  InterfaceMesh mesh = StartOf(scene);
  int questions = 0;
  InterfaceRemesher remesher(
    mesh, 1.1, 1.8, 1e-3, OnThisThread(), [&] { return ++questions < 3; });
  const int some = remesher.CollapseShortEdges();
  EXPECT_GT(some, 0);
  ExpectSound(mesh);
  InterfaceMesh whole = StartOf(scene);
  InterfaceRemesher other(whole, 1.1, 1.8, 1e-3, OnThisThread(), [] { return true; });
  EXPECT_LT(some, other.CollapseShortEdges());
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/FaceCubes.h"

#include "Core/Common/StandardThreads.h"
#include "Core/Interfaces/InterfaceStart.h"
#include "Core/Interfaces/InterfaceRemesher.h"
#include "InterfaceTestTools.h"

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
/** Begins with what is last. */
class BackwardExecutor final : public Executor
{
public:
  void For(std::size_t n, std::size_t,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override
  {
    for (; n > 0; --n)
    {
      body(n - 1, n);
    }
  }
};

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

TEST(InterfaceRemesher, MakesTheSameEditsInAnyOrderOfCubes)
{
  const InterfaceScene scene(ManyCells(64, 60, 2));
  const InterfaceMesh start = StartOf(scene);
  const InterfaceMesh forward = Edited(start, OnThisThread());
  ExpectSound(forward);
  BackwardExecutor backward;
  ExpectSame(Edited(start, backward), forward);
  StandardThreads threads(3);
  ExpectSame(Edited(start, threads), forward);
}

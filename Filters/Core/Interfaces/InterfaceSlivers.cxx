// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How InterfaceEdits removes triangles with a small angle.

#include "Core/Interfaces/InterfaceEdits.h"

#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Cosine of the angle between two faces of which one is a sliver, and whose edge is flipped. */
constexpr double LeastSliverCosine = 0.5;
}

bool InterfaceEdits::RemoveSliver(int face)
{
  const std::array<int, 3> v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  if (SmallestAngle(TriangleOf(this->Mesh, v)) >= SliverAngle)
  {
    return false;
  }
  std::array<int, 3> order = { 0, 1, 2 };
  std::sort(order.begin(), order.end(),
    [&](int a, int b) {
      return this->SquaredEdge(v[a], v[(a + 1) % 3]) < this->SquaredEdge(v[b], v[(b + 1) % 3]);
    });
  const int shortest = order[0];
  const int longest = order[2];
  return this->TryFlip(v[longest], v[(longest + 1) % 3], LeastSliverCosine) ||
    this->TryCollapse(v[shortest], v[(shortest + 1) % 3]);
}
}

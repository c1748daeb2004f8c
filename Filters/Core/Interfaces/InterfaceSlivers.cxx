// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How InterfaceRemesher removes triangles with a small angle.

#include "Core/Interfaces/InterfaceRemesher.h"

#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>

namespace volumic
{
namespace
{
/** Cosine of the angle between two faces of which one is a sliver, and whose edge is flipped. */
constexpr double LeastSliverCosine = 0.5;
/** Triangles with a smaller angle are slivers, radian. */
constexpr double LeastAngle = 0.5;
}

int InterfaceRemesher::RemoveSlivers()
{
  this->LayGrid();
  int count = 0;
  for (std::size_t f = 0; f < this->Mesh.Faces.size() && this->GoesOn(f); ++f)
  {
    const std::array<int, 3> v = this->Mesh.Faces[f].Vertex;
    if (!this->Mesh.Faces[f].IsThere())
    {
      continue;
    }
    const MeshTriangle t = TriangleOf(this->Mesh, v);
    if (SmallestAngle(t.Corner[0], t.Corner[1], t.Corner[2]) >= LeastAngle)
    {
      continue;
    }
    std::array<int, 3> order = { 0, 1, 2 };
    std::sort(order.begin(), order.end(),
      [&](int a, int b)
      {
        return this->SquaredEdge(v[a], v[(a + 1) % 3]) < this->SquaredEdge(v[b], v[(b + 1) % 3]);
      });
    const int shortest = order[0];
    const int longest = order[2];
    count += this->TryFlip(v[longest], v[(longest + 1) % 3], LeastSliverCosine) ||
        this->TryCollapse(v[shortest], v[(shortest + 1) % 3]) ||
        std::any_of(v.begin(), v.end(), [this](int corner) { return this->TryMove(corner); })
      ? 1
      : 0;
  }
  return count;
}

bool InterfaceRemesher::TryMove(int v)
{
  if (this->Mesh.StratumOf[static_cast<std::size_t>(v)] != Stratum::Interface)
  {
    return false;
  }
  const VectorD place(this->Mesh.Position[static_cast<std::size_t>(v)]);
  this->Mesh.FindNeighbours(v, this->First);
  VectorD middle;
  for (const int w : this->First)
  {
    middle += VectorD(this->Mesh.Position[static_cast<std::size_t>(w)]) *
      (1. / static_cast<double>(this->First.size()));
  }
  VectorD normal;
  this->Mesh.ForFaces(v, [&](int f)
    { normal += this->Mesh.NormalOf(this->Mesh.Faces[static_cast<std::size_t>(f)]); });
  normal = Normalized(normal);
  const VectorD way = middle - place - normal * Dot(normal, middle - place); // No volume is lost.
  for (const double share : { 1., 0.5, 0.25 })
  {
    const Vector target(place + way * share);
    this->Made.clear();
    this->Changed.clear();
    double before = 1.;
    double after = 1.;
    bool isFair = true;
    this->Mesh.ForFaces(v,
      [&](int f)
      {
        PlacedFace t = PlacedFaceOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(f)]);
        const VectorD old = NormalOf(t);
        before = std::min(before, RadiusRatio(t));
        t.Corner[std::find(t.Vertex, t.Vertex + 3, v) - t.Vertex] = VectorD(target);
        after = std::min(after, RadiusRatio(t));
        isFair = isFair && CosineOf(old, NormalOf(t)) > LeastTurnCosine;
        this->Changed.push_back(f);
        this->Made.push_back(t);
      });
    if (isFair && after > before &&
      this->Clearance.AreClear(this->Made, this->Changed, this->Near))
    {
      this->Mesh.Position[static_cast<std::size_t>(v)] = target;
      for (const int f : this->Changed)
      {
        this->Clearance.Change(f);
      }
      return true;
    }
  }
  return false;
}
}

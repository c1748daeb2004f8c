// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How InterfaceEdits removes triangles with a small angle.

#include "Core/Interfaces/InterfaceEdits.h"

#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Cosine of the angle between two faces of which one is a sliver, and whose edge is flipped. */
constexpr double LeastSliverCosine = 0.5;
/** How far a sliver's vertices are moved at a time, in the longest edge: half as far and so on, */
constexpr double LargestMove = 0.2;
constexpr double SmallestMove = 0.01;
/** and so often at most by each of these. */
constexpr int MostMoves = 8;
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
  const bool isDone = this->TryFlip(v[longest], v[(longest + 1) % 3], LeastSliverCosine) ||
    this->TryCollapse(v[shortest], v[(shortest + 1) % 3]) ||
    std::any_of(v.begin(), v.end(), [this](int corner) { return this->TryMove(corner); });
  return this->TryMoveAbout(face) || isDone;
}

bool InterfaceEdits::TryMove(int v)
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
  this->Mesh.ForFaces(v,
    [&](int f) { normal += this->Mesh.NormalOf(this->Mesh.Faces[static_cast<std::size_t>(f)]); });
  normal = Normalized(normal);
  const VectorD way = middle - place - normal * Dot(normal, middle - place); // No volume is lost.
  return this->TryMoveTo(v, Vector(place + way)) || this->TryMoveTo(v, Vector(place + way * 0.5)) ||
    this->TryMoveTo(v, Vector(place + way * 0.25));
}

bool InterfaceEdits::TryMoveTo(int v, const Vector& wanted, int face)
{
  const Vector target = this->Mesh.OnSides(v, wanted);
  this->Made.clear();
  this->Changed.clear();
  double before = 1.;
  double after = 1.;
  bool isFair = true;
  bool isBetter = face >= 0;
  this->Mesh.FindImages(v, v, this->Images);
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.ForFaces(image[0],
      [&](int f)
      {
        PlacedFace t = PlacedFaceOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(f)]);
        const MeshTriangle old = t;
        t.Corner[std::find(t.Vertex, t.Vertex + 3, image[0]) - t.Vertex] =
          VectorD(this->Mesh.OnSides(image[0], target));
        before = std::min(before, RadiusRatio(old));
        after = std::min(after, RadiusRatio(t));
        isFair = isFair && CosineOf(NormalOf(old), NormalOf(t)) > LeastTurnCosine;
        if (isBetter)
        {
          const double angle = SmallestAngle(old);
          isBetter =
            f == face ? SmallestAngle(t) > angle : SmallestAngle(t) >= std::min(angle, SliverAngle);
        }
        this->Changed.push_back(f);
        this->Made.push_back(t);
      });
  }
  isBetter = isBetter || after > before;
  if (!isFair || !isBetter || !this->Clearance.AreClear(this->Made, this->Changed, this->Near))
  {
    return false;
  }
  for (const std::array<int, 2>& image : this->Images)
  {
    this->Mesh.Position[static_cast<std::size_t>(image[0])] = this->Mesh.OnSides(image[0], target);
  }
  for (const int f : this->Changed)
  {
    this->Clearance.Change(f);
  }
  return true;
}

bool InterfaceEdits::TryMoveAbout(int face)
{
  const std::array<int, 3> v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  // At lines voxels would be cut off for shapes that lines do not allow.
  const auto isOffLines = [this](int corner)
  {
    return corner >= 0 &&
      this->Mesh.StratumOf[static_cast<std::size_t>(corner)] == Stratum::Interface;
  };
  if (!std::all_of(v.begin(), v.end(), isOffLines))
  {
    return false;
  }
  bool hasMoved = false;
  for (double share = LargestMove; share > SmallestMove; share *= 0.5)
  {
    for (int n = 0; n < MostMoves && SmallestAngle(TriangleOf(this->Mesh, v)) < SliverAngle; ++n)
    {
      bool moves = false;
      for (const int corner : v)
      {
        moves = this->TryMoveAlongSides(corner, face, share) || moves;
      }
      hasMoved = hasMoved || moves;
      if (!moves)
      {
        break;
      }
    }
  }
  return hasMoved;
}

bool InterfaceEdits::TryMoveAlongSides(int corner, int face, double share)
{
  const MeshTriangle t =
    TriangleOf(this->Mesh, this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex);
  const VectorD normal = Normalized(NormalOf(t));
  const VectorD place(this->Mesh.Position[static_cast<std::size_t>(corner)]);
  const double length = share * std::sqrt(static_cast<double>(this->Longest));
  for (int k = 0; k < 4; ++k)
  {
    const VectorD way = (k < 3 ? Normalized(t.Corner[(k + 1) % 3] - t.Corner[k]) : normal) * length;
    if (this->TryMoveTo(corner, Vector(place + way), face) ||
      this->TryMoveTo(corner, Vector(place - way), face))
    {
      return true;
    }
  }
  return false;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceEdits.h"

#include "Core/Interfaces/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace volumic
{
namespace
{
/** Least cosine between the normals of two faces whose edge is flipped. */
constexpr double LeastFlatCosine = 0.85;
constexpr double LeastSliverCosine = 0.5; ///< the same if one of the faces is a sliver
/** A collapse creates triangles of a smaller RadiusRatio() only if the old ones were worse. */
constexpr double LeastRatio = 0.3;
/** RadiusRatio() below which the normal of a triangle is unreliable. */
constexpr double SliverRatio = 0.15;
/** Flips are tried for triangles with a smaller angle, in radians. */
constexpr double LeastGoodAngle = 0.8;
/** Least increase of the smallest angle by a flip, in radians. */
constexpr double LeastGain = 0.02;
}

InterfaceEdits::InterfaceEdits(
  InterfaceMesh& mesh, InterfaceClearance& clearance, double shortest, double longest)
  : Mesh(mesh), Clearance(clearance), Shortest(static_cast<float>(shortest * shortest)),
    Longest(static_cast<float>(longest * longest))
{
}

bool InterfaceEdits::TrySplit(int face)
{
  const std::array<int, 3> v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  int longest = 0;
  float length = 0.f;
  for (int k = 0; k < 3; ++k)
  {
    const float squared =
      this->SquaredEdge(v[k], v[(k + 1) % 3]) / this->SquaredSize(v[k], v[(k + 1) % 3]);
    if (squared > length)
    {
      longest = k;
      length = squared;
    }
  }
  if (!(length > this->Longest))
  {
    return false;
  }
  this->Split(v[longest], v[(longest + 1) % 3]);
  return true;
}

void InterfaceEdits::Split(int u, int v)
{
  this->Mesh.FindImages(u, v, this->Images);
  std::vector<int> added;
  std::transform(this->Images.begin(), this->Images.end(), std::back_inserter(added),
    [this](const std::array<int, 2>& edge) { return this->SplitOne(edge[0], edge[1]); });
  this->Mesh.JoinImages(added);
}

int InterfaceEdits::SplitOne(int u, int v)
{
  this->Mesh.FindFaces(u, v, this->AtEdge);
  const Vector middle = (this->Mesh.Position[static_cast<std::size_t>(u)] +
                          this->Mesh.Position[static_cast<std::size_t>(v)]) *
    0.5f;
  const int added = this->Mesh.AddVertex(middle,
    this->Mesh.IsLine(this->AtEdge) ? Stratum::Line : Stratum::Interface, this->Mesh.SizeOf(u, v));
  for (const int f : this->AtEdge)
  {
    InterfaceMesh::Face half = this->Mesh.Faces[static_cast<std::size_t>(f)];
    std::replace(half.Vertex.begin(), half.Vertex.end(), u, added);
    this->Mesh.ReplaceVertex(f, v, added);
    this->Mesh.AddFace(half);
  }
  return added;
}

int InterfaceEdits::CollapseAt(int face)
{
  const InterfaceMesh::Face& at = this->Mesh.Faces[static_cast<std::size_t>(face)];
  int count = 0;
  for (int k = 0; k < 3 && at.IsThere(); ++k)
  {
    const int u = at.Vertex[k];
    const int v = at.Vertex[(k + 1) % 3];
    const bool isShort = this->SquaredEdge(u, v) < this->Shortest * this->SquaredSize(u, v);
    count += isShort && this->TryCollapse(u, v) ? 1 : 0;
  }
  return count;
}

bool InterfaceEdits::MayCollapse(int u, int v)
{
  const Stratum lower = std::min(this->Mesh.StratumOf[static_cast<std::size_t>(u)],
    this->Mesh.StratumOf[static_cast<std::size_t>(v)]);
  this->Mesh.FindFaces(u, v, this->AtEdge);
  const bool isOnLine = this->Mesh.IsLine(this->AtEdge);
  if (isOnLine != (lower != Stratum::Interface))
  {
    return false; // Two junction lines would meet, or a vertex would leave its line.
  }
  if (lower == Stratum::Corner && !this->ShareObjects(u, v))
  {
    return false;
  }
  this->Mesh.FindNeighbours(u, this->First);
  this->Mesh.FindNeighbours(v, this->Second);
  const auto countOf = [](const std::vector<int>& neighbours, int w)
  { return std::count(neighbours.begin(), neighbours.end(), w); };
  for (const int f : this->AtEdge)
  {
    const int w = this->Mesh.Faces[static_cast<std::size_t>(f)].Opposite(u, v);
    if (countOf(this->First, w) > 2 && countOf(this->Second, w) > 2)
    {
      return false;
    }
  }
  const auto unique = [](std::vector<int>& neighbours)
  { neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end()); };
  unique(this->First);
  unique(this->Second);
  std::vector<int>& common = this->Common;
  common.clear();
  std::set_intersection(this->First.begin(), this->First.end(), this->Second.begin(),
    this->Second.end(), std::back_inserter(common));
  return common.size() == this->AtEdge.size();
}

bool InterfaceEdits::ShareObjects(int u, int v)
{
  const auto findWhole = [this](int w, std::vector<int>& objects)
  {
    this->Mesh.FindObjects(w, objects);
    std::transform(objects.begin(), objects.end(), objects.begin(),
      [this](int object) { return this->Mesh.Whole(object); });
    std::sort(objects.begin(), objects.end());
  };
  findWhole(u, this->First);
  findWhole(v, this->Second);
  this->Common.clear();
  std::set_intersection(this->First.begin(), this->First.end(), this->Second.begin(),
    this->Second.end(), std::back_inserter(this->Common));
  return std::all_of(this->Common.begin(), this->Common.end(),
    [&](int object)
    {
      return std::any_of(this->AtEdge.begin(), this->AtEdge.end(),
        [&](int f)
        {
          const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
          return this->Mesh.Whole(face.Behind) == object || this->Mesh.Whole(face.Front) == object;
        });
    });
}

bool InterfaceEdits::TryCollapse(int u, int v)
{
  const auto rankOf = [this](int w)
  {
    return std::pair(
      this->Mesh.StratumOf[static_cast<std::size_t>(w)], this->Mesh.NumberOfImages(w));
  };
  const int kept = rankOf(u) >= rankOf(v) ? u : v;
  const int removed = kept == u ? v : u;
  this->Mesh.FindImages(kept, removed, this->Images);
  if (static_cast<int>(this->Images.size()) != this->Mesh.NumberOfImages(removed))
  {
    return false;
  }
  const Vector position = this->Mesh.Position[static_cast<std::size_t>(kept)];
  const Vector other = this->Mesh.Position[static_cast<std::size_t>(removed)];
  const bool isSameStratum = rankOf(kept).first == rankOf(removed).first;
  const std::array<Vector, 3> positions = { isSameStratum ? (position + other) * 0.5f : position,
    position, other };
  // Test the quality of the new faces first: it is the cheapest test and rejects most collapses.
  bool isAllowed = false;
  for (std::size_t n = 0; n < (isSameStratum ? positions.size() : 1); ++n)
  {
    if (!this->AreFairCollapses(positions[n]))
    {
      continue;
    }
    isAllowed = isAllowed || this->MayCollapseImages();
    if (!isAllowed)
    {
      return false;
    }
    if (this->Clearance.AreClear(this->Made, this->Changed, this->Near))
    {
      this->CollapseImages(positions[n]);
      return true;
    }
  }
  return false;
}

bool InterfaceEdits::MayCollapseImages()
{
  return std::all_of(this->Images.begin(), this->Images.end(),
    [this](const std::array<int, 2>& edge)
    {
      return this->Mesh.StratumOf[static_cast<std::size_t>(edge[0])] >=
        this->Mesh.StratumOf[static_cast<std::size_t>(edge[1])] &&
        this->MayCollapse(edge[0], edge[1]);
    });
}

Vector InterfaceEdits::PositionOfImage(std::size_t image, const Vector& position) const
{
  return image == 0 ? position : this->Mesh.ProjectToSides(this->Images[image][0], position);
}

bool InterfaceEdits::AreFairCollapses(const Vector& position)
{
  this->Made.clear();
  this->Changed.clear();
  for (std::size_t n = 0; n < this->Images.size(); ++n)
  {
    const std::array<int, 2>& edge = this->Images[n];
    if (!this->IsFairCollapse(this->PositionOfImage(n, position), edge[0], edge[1]))
    {
      return false;
    }
  }
  return true;
}

void InterfaceEdits::CollapseImages(const Vector& position)
{
  for (std::size_t n = 0; n < this->Images.size(); ++n)
  {
    const std::array<int, 2>& edge = this->Images[n];
    this->Collapse(this->PositionOfImage(n, position), edge[0], edge[1]);
  }
  for (const int f : this->Changed)
  {
    this->Clearance.Change(f);
  }
}

bool InterfaceEdits::IsFairCollapse(const Vector& position, int kept, int removed)
{
  const auto firstMade = static_cast<std::ptrdiff_t>(this->Made.size());
  for (const int v : { kept, removed })
  {
    if (SquaredDistance(this->Mesh.ProjectToSides(v, position), position) > 0.f)
    {
      return false; // A face would leave its side of the box.
    }
  }
  if (this->MakesLongEdges(position, kept, removed))
  {
    return false;
  }
  double worst = 1.;
  for (const int v : { kept, removed })
  {
    bool isFair = true;
    this->Mesh.ForFaces(v,
      [&](int f)
      {
        const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
        if (!isFair || (v == removed && face.Has(kept)))
        {
          return;
        }
        const FaceCoordinates before = FaceCoordinatesOf(this->Mesh, face);
        const double ratio = RadiusRatio(before);
        worst = std::min(worst, ratio);
        this->Changed.push_back(f);
        if (face.Has(removed) && v == kept)
        {
          return;
        }
        FaceCoordinates after = before;
        const auto k = std::find(after.Vertex, after.Vertex + 3, v) - after.Vertex;
        after.Vertex[k] = kept;
        after.Corner[k] = VectorD(position);
        // The normals of slivers are unreliable.
        isFair =
          ratio < SliverRatio || CosineOf(NormalOf(before), NormalOf(after)) > LeastTurnCosine;
        this->Made.push_back(after);
      });
    if (!isFair)
    {
      return false;
    }
  }
  const double least = std::min(worst, LeastRatio);
  return std::all_of(this->Made.begin() + firstMade, this->Made.end(),
    [least](const MeshTriangle& triangle) { return RadiusRatio(triangle) >= least; });
}

bool InterfaceEdits::MakesLongEdges(const Vector& position, int kept, int removed) const
{
  // Short edges at junction points bend lines. Allow longer edges instead, which are split later.
  const double longest = this->Longest *
    (this->Mesh.StratumOf[static_cast<std::size_t>(kept)] == Stratum::Corner
        ? CornerFactor * CornerFactor
        : 1.);
  bool isLong = false;
  for (const int v : { kept, removed })
  {
    this->Mesh.ForFaces(v,
      [&](int f)
      {
        for (const int w : this->Mesh.Faces[static_cast<std::size_t>(f)].Vertex)
        {
          const Vector& end = this->Mesh.Position[static_cast<std::size_t>(w)];
          isLong = isLong ||
            (w != kept && w != removed &&
              SquaredDistance(VectorD(end), VectorD(position)) >
                longest * this->SquaredSize(kept, w));
        }
      });
  }
  return isLong;
}

void InterfaceEdits::Collapse(const Vector& position, int kept, int removed)
{
  for (const int f : this->Changed)
  {
    const InterfaceMesh::Face& face = this->Mesh.Faces[static_cast<std::size_t>(f)];
    if (face.Has(kept) && face.Has(removed))
    {
      this->Mesh.RemoveFace(f);
    }
    else if (face.Has(removed))
    {
      this->Mesh.ReplaceVertex(f, removed, kept);
    }
  }
  this->Mesh.Position[static_cast<std::size_t>(kept)] = position;
}

int InterfaceEdits::FlipAt(int face)
{
  const std::array<int, 3> v = this->Mesh.Faces[static_cast<std::size_t>(face)].Vertex;
  if (SmallestAngle(TriangleOf(this->Mesh, v)) > LeastGoodAngle)
  {
    return 0; // The flip is tried from the worse of the two faces.
  }
  for (int k = 0; k < 3; ++k)
  {
    if (this->TryFlip(v[k], v[(k + 1) % 3], LeastFlatCosine))
    {
      return 1;
    }
  }
  return 0;
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
    [&](int a, int b)
    { return this->SquaredEdge(v[a], v[(a + 1) % 3]) < this->SquaredEdge(v[b], v[(b + 1) % 3]); });
  const int shortest = order[0];
  const int longest = order[2];
  return this->TryFlip(v[longest], v[(longest + 1) % 3], LeastSliverCosine) ||
    this->TryCollapse(v[shortest], v[(shortest + 1) % 3]);
}

bool InterfaceEdits::TryFlip(int u, int v, double flatness)
{
  this->Made.clear();
  this->Changed.clear();
  this->Mesh.FindImages(u, v, this->Images);
  if (!std::all_of(this->Images.begin(), this->Images.end(),
        [&](const std::array<int, 2>& edge)
        { return this->IsFairFlip(edge[0], edge[1], flatness); }) ||
    !this->Clearance.AreClear(this->Made, this->Changed, this->Near))
  {
    return false;
  }
  for (std::size_t n = 0; n < this->Changed.size(); n += 2)
  {
    const std::array<int, 2>& edge = this->Images[n / 2];
    const int f = this->Changed[n];
    const int g = this->Changed[n + 1];
    const auto oppositeIn = [&](int face)
    { return this->Mesh.Faces[static_cast<std::size_t>(face)].Opposite(edge[0], edge[1]); };
    const int p = oppositeIn(f);
    const int q = oppositeIn(g);
    this->Mesh.ReplaceVertex(f, edge[1], q);
    this->Mesh.ReplaceVertex(g, edge[0], p);
    this->Clearance.Change(f);
    this->Clearance.Change(g);
  }
  return true;
}

bool InterfaceEdits::IsFairFlip(int u, int v, double flatness)
{
  this->Mesh.FindFaces(u, v, this->AtEdge);
  if (this->AtEdge.size() != 2 || this->Mesh.IsLine(this->AtEdge))
  {
    return false;
  }
  const int f = this->AtEdge[0];
  const int g = this->AtEdge[1];
  InterfaceMesh::Face first = this->Mesh.Faces[static_cast<std::size_t>(f)];
  InterfaceMesh::Face second = this->Mesh.Faces[static_cast<std::size_t>(g)];
  const int p = first.Opposite(u, v);
  const int q = second.Opposite(u, v);
  if (p == q || this->SquaredEdge(p, q) > this->Longest * this->SquaredSize(p, q))
  {
    return false;
  }
  const MeshTriangle before[2] = { TriangleOf(this->Mesh, first.Vertex),
    TriangleOf(this->Mesh, second.Vertex) };
  std::replace(first.Vertex.begin(), first.Vertex.end(), v, q);
  std::replace(second.Vertex.begin(), second.Vertex.end(), u, p);
  const FaceCoordinates after[2] = { FaceCoordinatesOf(this->Mesh, first),
    FaceCoordinatesOf(this->Mesh, second) };
  if (std::min(SmallestAngle(after[0]), SmallestAngle(after[1])) <
    std::min(SmallestAngle(before[0]), SmallestAngle(before[1])) + LeastGain)
  {
    return false;
  }
  const VectorD normals[2] = { NormalOf(before[0]), NormalOf(before[1]) };
  const VectorD both = normals[0] + normals[1];
  this->Changed.insert(this->Changed.end(), { f, g });
  this->Made.insert(this->Made.end(), { after[0], after[1] });
  return CosineOf(normals[0], normals[1]) >= flatness &&
    CosineOf(NormalOf(after[0]), both) >= LeastTurnCosine &&
    CosineOf(NormalOf(after[1]), both) >= LeastTurnCosine && !this->Mesh.HasEdge(p, q);
}
}

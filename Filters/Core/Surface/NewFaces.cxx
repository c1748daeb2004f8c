// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/NewFaces.h"

#include "Core/Common/Box.h"
#include "Core/Common/Spans.h"
#include "Core/Surface/FaceShape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Clearance, in delta, on one side of a plane beyond which two faces need no exact test. */
constexpr float PlaneClearance = 0.01f;
/** Twice the least area, in delta squared, with a reliable normal in float. */
constexpr float LeastArea = 1e-2f;
/** Factor of lambda: edges may exceed their bound until the end of an iteration. */
constexpr float EdgeTolerance = 1.1f;

/** Factor that makes a rounded length an upper bound. */
constexpr float AboveRounding = 1.0001f;

constexpr std::size_t TestedSpan = 512;

/** A new face with a bounding box and a plane in float, which exclude most intersections. */
struct NewFace
{
  NewFace(const MeshTriangle& face, float delta)
    : Corners(face), Origin(face.Corner[0]),
      Bounds(Box::Of(this->Origin, Vector(face.Corner[1]), Vector(face.Corner[2])))
  {
    const Vector normal =
      Cross(Vector(face.Corner[1]) - this->Origin, Vector(face.Corner[2]) - this->Origin);
    this->Normal = Normalized(normal);
    this->HasNormal = Length(normal) > LeastArea * delta * delta;
  }

  /**
   * Return whether two faces cannot intersect: the corners of the other face that are not shared
   * lie on one side of the plane with some clearance, or the faces share an edge and are not
   * folded.
   */
  bool IsSeparatedFrom(const NewFace& other, float clearance) const
  {
    if (!this->HasNormal || !other.HasNormal)
    {
      return false;
    }
    const int* name = this->Corners.Vertex;
    int shared = 0;
    bool above = true;
    bool below = true;
    for (int k = 0; k < 3; ++k)
    {
      const int corner = other.Corners.Vertex[k];
      if (corner == name[0] || corner == name[1] || corner == name[2])
      {
        ++shared;
        continue;
      }
      const float height = Dot(this->Normal, Vector(other.Corners.Corner[k]) - this->Origin);
      above = above && height > clearance;
      below = below && height < -clearance;
    }
    return shared < 2 ? above || below : shared == 2 && Dot(this->Normal, other.Normal) > Unfolded;
  }

  const MeshTriangle& Corners;
  Vector Origin;
  Box Bounds;
  Vector Normal;  ///< Unit.
  bool HasNormal; ///< False for slivers.
};

/** Return the faces of a star, as bits, both of whose neighbours are in a set of bits. */
unsigned FacesOf(const Ring& ring, unsigned neighbours)
{
  return neighbours & (neighbours >> 1 | (neighbours & 1u) << (ring.Count - 1));
}

bool Intersect(const SurfaceState& state, const MeshTriangle& one, const MeshTriangle& other)
{
  return TrianglesIntersect(one, other, state.Sizing.Contact(one.Vertex[0]));
}

bool IntersectEachOther(const SurfaceState& state, const std::vector<NewFace>& faces)
{
  const float clearance = PlaneClearance * state.Sizing.At(faces[0].Corners.Vertex[0]);
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    for (std::size_t j = i + 1; j < faces.size(); ++j)
    {
      if (!faces[i].IsSeparatedFrom(faces[j], clearance) &&
        !faces[j].IsSeparatedFrom(faces[i], clearance) &&
        Intersect(state, faces[i].Corners, faces[j].Corners))
      {
        return true;
      }
    }
  }
  return false;
}

/** Return whether any new face intersects the face (w, u, v) of the mesh. */
bool IntersectFace(const SurfaceState& state, const std::vector<NewFace>& newFaces, int w, int u,
  int v, const Box& bounds)
{
  const auto isNear = [&](const NewFace& face) { return !bounds.IsApartFrom(face.Bounds); };
  if (std::none_of(newFaces.begin(), newFaces.end(), isNear))
  {
    return false;
  }
  const float delta = state.Sizing.At(w);
  const float clearance = PlaneClearance * delta;
  const MeshTriangle triangle = TriangleOf(state.Mesh, w, u, v);
  const NewFace other(triangle, delta);
  return std::any_of(newFaces.begin(), newFaces.end(),
    [&](const NewFace& face)
    {
      return isNear(face) && !face.IsSeparatedFrom(other, clearance) &&
        !other.IsSeparatedFrom(face, clearance) && Intersect(state, face.Corners, triangle);
    });
}
}

bool NewFacesIntersect(
  const SurfaceState& state, const std::vector<MeshTriangle>& faces, const RemovedFaces& removed)
{
  std::vector<NewFace> newFaces;
  newFaces.reserve(faces.size());
  Box all = { Vector(faces[0].Corner[0]), Vector(faces[0].Corner[0]) };
  for (const MeshTriangle& face : faces)
  {
    newFaces.emplace_back(face, state.Sizing.At(face.Vertex[0]));
    all = all.With(newFaces.back().Bounds);
  }
  if (IntersectEachOther(state, newFaces))
  {
    return true;
  }
  // An intersecting face has a corner within this distance of the box of the new faces.
  float radius = 0.f;
  for (const MeshTriangle& face : faces)
  {
    for (const int v : face.Vertex)
    {
      radius =
        std::max(radius, state.Sizing.ScaledRadius(v, EdgeTolerance * SizingField::LambdaInDelta));
    }
  }
  const Box visited = all.Grown(radius);
  const SurfaceMesh& mesh = state.Mesh;
  const auto isVisited = [&](int w) { return visited.Contains(mesh.Position[w]); };
  bool intersects = false;
  state.Grid.VisitBox(visited.Low, visited.High,
    [&](int w)
    {
      if (intersects || !isVisited(w))
      {
        return;
      }
      // Test a face at the smallest of its corners that are visited.
      const Ring& ring = mesh.Rings[w];
      unsigned tested = 0;
      for (int i = 0; i < ring.Count; ++i)
      {
        const int u = ring.Item[i];
        tested |= (u > w || !isVisited(u) ? 1u : 0u) << i;
      }
      for (unsigned faces = FacesOf(ring, tested); faces != 0 && !intersects; faces &= faces - 1)
      {
        const int i = LowestBit(faces);
        const int u = ring.Item[i];
        const int v = ring.Next(i);
        const Box bounds = Box::Of(mesh.Position[w], mesh.Position[u], mesh.Position[v]);
        intersects = !bounds.IsApartFrom(all) && !removed.Contains({ w, u, v }) &&
          IntersectFace(state, newFaces, w, u, v, bounds);
      }
    });
  return intersects;
}
namespace
{
/** Tests the faces whose smallest vertex is given. */
class FacesOfMesh
{
public:
  /** @param longest longest edge of each vertex */
  FacesOfMesh(const SurfaceState& state, const LargeVector<float>& longest)
    : State(state), Longest(longest)
  {
  }

  /**
   * Return whether the faces of v intersect each other, or those of a vertex w with shorter edges,
   * or with equal ones and w < v.
   */
  bool Intersect(int v)
  {
    this->Faces.clear();
    this->NewFaces.clear();
    this->VisitFaces(
      v, [&](int a, int b) { this->Faces.push_back(TriangleOf(this->State.Mesh, v, a, b)); });
    if (this->Faces.empty())
    {
      return false;
    }
    const Vector position = this->State.Mesh.Position[v];
    Box all = { position, position };
    for (const MeshTriangle& face : this->Faces)
    {
      this->NewFaces.emplace_back(face, this->State.Sizing.At(v));
      all = all.With(this->NewFaces.back().Bounds);
    }
    if (IntersectEachOther(this->State, this->NewFaces))
    {
      return true;
    }
    const Box visited = all.Grown(this->Longest[v]);
    bool intersect = false;
    this->State.Grid.VisitBox(visited.Low, visited.High,
      [&](int w)
      {
        if (!intersect && w != v && visited.Contains(this->State.Mesh.Position[w]) &&
          this->IsBefore(w, v))
        {
          this->VisitFaces(
            w, [&](int a, int b) { intersect = intersect || this->IntersectFaceOf(w, a, b, all); });
        }
      });
    return intersect;
  }

private:
  template <typename Visit>
  void VisitFaces(int v, const Visit& visit) const
  {
    const Ring& ring = this->State.Mesh.Rings[v];
    unsigned after = 0;
    for (int i = 0; i < ring.Count; ++i)
    {
      after |= (ring.Item[i] > v ? 1u : 0u) << i;
    }
    for (unsigned faces = FacesOf(ring, after); faces != 0; faces &= faces - 1)
    {
      const int i = LowestBit(faces);
      visit(ring.Item[i], ring.Next(i));
    }
  }

  bool IsBefore(int w, int v) const
  {
    return this->Longest[w] != this->Longest[v] ? this->Longest[w] < this->Longest[v] : w < v;
  }

  bool IntersectFaceOf(int w, int a, int b, const Box& all) const
  {
    const LargeVector<Vector>& position = this->State.Mesh.Position;
    const Box bounds = Box::Of(position[w], position[a], position[b]);
    return !bounds.IsApartFrom(all) && IntersectFace(this->State, this->NewFaces, w, a, b, bounds);
  }

  const SurfaceState& State;
  const LargeVector<float>& Longest;
  std::vector<MeshTriangle> Faces;
  std::vector<NewFace> NewFaces;
};
}

std::size_t CountIntersecting(const SurfaceState& state, Executor& executor)
{
  const SurfaceMesh& mesh = state.Mesh;
  LargeVector<float> longest(mesh.Rings.size(), 0.f);
  executor.For(longest.size(), TestedSpan,
    [&](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        const Ring& ring = mesh.Rings[v];
        float squared = 0.f;
        for (int i = 0; i < ring.Count; ++i)
        {
          squared =
            std::max(squared, SquaredDistance(mesh.Position[v], mesh.Position[ring.Item[i]]));
        }
        longest[v] = std::sqrt(squared) * AboveRounding;
      }
    });
  return CountInSpans(executor, state.Mesh.Rings.size(), TestedSpan,
    [&](std::size_t begin, std::size_t end)
    {
      FacesOfMesh faces(state, longest);
      std::size_t count = 0;
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        count += state.Mesh.IsAlive(v) && faces.Intersect(v);
      }
      return count;
    });
}
}

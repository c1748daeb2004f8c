// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/Division.h"

#include "Core/Common/Spans.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::size_t SpanSize = 8192;
}

void KeptEdges::KeepAt(int v, int neighbour)
{
  this->Flags[v] |= static_cast<RingFlags>(1u << this->Mesh.Rings[v].Find(neighbour));
}

void KeptEdges::Keep(int u, int v)
{
  this->KeepAt(u, v);
  this->KeepAt(v, u);
}

void KeptEdges::KeepAllAt(int v)
{
  for (int i = 0; i < this->Mesh.Rings[v].Count; ++i)
  {
    this->Keep(v, this->Mesh.Rings[v].Item[i]);
  }
}

void KeptEdges::KeepAll()
{
  for (int v = 0; v < this->Mesh.Size(); ++v)
  {
    this->Flags[v] = static_cast<RingFlags>((1u << this->Mesh.Rings[v].Count) - 1u);
  }
}

std::vector<int> KeptEdges::FindOverfull() const
{
  // Each run of kept edges adds a neighbour, unless all edges are kept.
  std::vector<int> found;
  for (int v = 0; v < this->Mesh.Size(); ++v)
  {
    const int count = this->Mesh.Rings[v].Count;
    int runs = 0;
    for (int i = 0; i < count; ++i)
    {
      runs += this->Has(v, i) && !this->HasAfter(v, i);
    }
    if (count + runs > Ring::Capacity)
    {
      found.push_back(v);
    }
  }
  return found;
}

int KeptEdges::CountFrom(int v) const
{
  const Ring& ring = this->Mesh.Rings[v];
  int count = 0;
  for (int i = 0; i < ring.Count; ++i)
  {
    count += v < ring.Item[i] && this->Has(v, i);
  }
  return count;
}

namespace
{
/** Compute the sums of countOf(v) over all vertices before each one. Return the total. */
template <typename CountOf>
int AddUp(LargeVector<int>& first, std::size_t n, Executor& executor, const CountOf& countOf)
{
  MakeZeroed(first, n);
  const std::vector<std::size_t> before = FirstOfSpans(executor, n, SpanSize,
    [&](std::size_t begin, std::size_t end)
    {
      int sum = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        first[v] = countOf(v);
        sum += first[v];
      }
      return sum;
    });
  ForSpans(executor, n, SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      int next = static_cast<int>(before[span]);
      for (std::size_t v = begin; v < end; ++v)
      {
        const int count = first[v];
        first[v] = next;
        next += count;
      }
    });
  return static_cast<int>(before.back());
}
}

DivisionNumbers NumberForDivision(
  const SurfaceMesh& mesh, const KeptEdges* kept, Executor& executor)
{
  DivisionNumbers numbers;
  const std::size_t n = mesh.Rings.size();
  numbers.Faces = AddUp(numbers.FirstFace, n, executor,
    [&mesh](std::size_t v) { return static_cast<int>(mesh.CountFaces(v, v + 1)); });
  if (kept)
  {
    numbers.Midpoints = AddUp(numbers.FirstMidpoint, n, executor,
      [kept](std::size_t v) { return kept->CountFrom(static_cast<int>(v)); });
  }
  return numbers;
}

namespace
{
constexpr int None = -1;

void Append(Ring& ring, int vertex)
{
  if (vertex != None)
  {
    ring.Item[ring.Count++] = vertex;
  }
}

/** State of a division. */
class SqrtThreeDivision
{
public:
  SqrtThreeDivision(const SurfaceMesh& mesh, const DivisionNumbers& numbers, const KeptEdges* kept)
    : Mesh(mesh), Numbers(numbers), Kept(kept)
  {
    const auto n = static_cast<std::size_t>(this->FirstMidpoint() + numbers.Midpoints);
    this->Divided.Allocate(n);
  }

  /**
   * Make an old vertex, and the new ones of the faces and edges whose smallest vertex it is.
   * Thread-safe for different vertices.
   */
  void DivideAt(int v);
  SurfaceMesh Take() { return std::move(this->Divided); }

private:
  int FirstCentroid() const { return this->Mesh.Size(); }
  int FirstMidpoint() const { return this->Mesh.Size() + this->Numbers.Faces; }
  /** Return the centroid vertex of the face (a, b, c). */
  int CentroidOf(int a, int b, int c) const;
  /** Return the centroid vertex of the face to the left of an edge. */
  int CentroidLeftOf(int a, int b) const
  {
    return this->CentroidOf(a, b, this->Mesh.Rings[a].After(b));
  }
  /** Return the midpoint vertex of the edge from v to its neighbour i, or None if it is flipped. */
  int MidpointAt(int v, int i) const;
  int MidpointOf(int u, int v) const
  {
    return this->Kept ? this->MidpointAt(u, this->Mesh.Rings[u].Find(v)) : None;
  }
  void MakeCentroid(int centroid, const std::array<int, 3>& face);
  void MakeMidpoint(int midpoint, int u, int v);
  Ring RingOfOld(int v) const;

  const SurfaceMesh& Mesh;
  const DivisionNumbers& Numbers;
  const KeptEdges* Kept;
  SurfaceMesh Divided;
};

void SqrtThreeDivision::DivideAt(int v)
{
  const auto i = static_cast<std::size_t>(v);
  this->Divided.Position[i] = this->Mesh.Position[i];
  this->Divided.Rings[i] = this->RingOfOld(v);
  int centroid = this->FirstCentroid() + this->Numbers.FirstFace[i];
  this->Mesh.VisitFaces(i, i + 1,
    [&](int a, int b, int c) {
      this->MakeCentroid(centroid++, { a, b, c });
    });
  if (this->Kept)
  {
    int midpoint = this->FirstMidpoint() + this->Numbers.FirstMidpoint[i];
    const Ring& ring = this->Mesh.Rings[i];
    for (int k = 0; k < ring.Count; ++k)
    {
      if (v < ring.Item[k] && this->Kept->Has(v, k))
      {
        this->MakeMidpoint(midpoint++, v, ring.Item[k]);
      }
    }
  }
}

int SqrtThreeDivision::CentroidOf(int a, int b, int c) const
{
  const int smallest = std::min({ a, b, c });
  const int next = smallest == a ? b : smallest == b ? c : a;
  const Ring& ring = this->Mesh.Rings[smallest];
  int before = 0;
  for (int i = 0; ring.Item[i] != next; ++i)
  {
    before += smallest < ring.Item[i] && smallest < ring.Next(i);
  }
  return this->FirstCentroid() + this->Numbers.FirstFace[smallest] + before;
}

int SqrtThreeDivision::MidpointAt(int v, int i) const
{
  if (!this->Kept || !this->Kept->Has(v, i))
  {
    return None;
  }
  const int w = this->Mesh.Rings[v].Item[i];
  const int smaller = std::min(v, w);
  const int larger = std::max(v, w);
  const Ring& ring = this->Mesh.Rings[smaller];
  int before = 0;
  for (int k = 0; ring.Item[k] != larger; ++k)
  {
    before += smaller < ring.Item[k] && this->Kept->Has(smaller, k);
  }
  return this->FirstMidpoint() + this->Numbers.FirstMidpoint[smaller] + before;
}

void SqrtThreeDivision::MakeCentroid(int centroid, const std::array<int, 3>& face)
{
  const LargeVector<Vector>& position = this->Mesh.Position;
  this->Divided.Position[centroid] =
    (position[face[0]] + position[face[1]] + position[face[2]]) * (1.f / 3.f);
  // A corner, then the vertex across the edge to the next corner.
  Ring& ring = this->Divided.Rings[centroid];
  for (int k = 0; k < 3; ++k)
  {
    const int a = face[k];
    const int b = face[(k + 1) % 3];
    const int c = face[(k + 2) % 3];
    const int midpoint = this->MidpointOf(a, b);
    const bool isCutOff = midpoint != None && this->MidpointOf(a, c) != None;
    Append(ring, isCutOff ? None : a);
    Append(ring, midpoint != None ? midpoint : this->CentroidLeftOf(b, a));
  }
}

void SqrtThreeDivision::MakeMidpoint(int midpoint, int u, int v)
{
  const LargeVector<Vector>& position = this->Mesh.Position;
  this->Divided.Position[midpoint] = (position[u] + position[v]) * 0.5f;
  const int left = this->Mesh.Rings[u].After(v);
  const int right = this->Mesh.Rings[u].Before(v);
  Ring& ring = this->Divided.Rings[midpoint];
  Append(ring, u);
  Append(ring, this->MidpointOf(u, right));
  Append(ring, this->CentroidLeftOf(v, u));
  Append(ring, this->MidpointOf(v, right));
  Append(ring, v);
  Append(ring, this->MidpointOf(v, left));
  Append(ring, this->CentroidLeftOf(u, v));
  Append(ring, this->MidpointOf(u, left));
}

Ring SqrtThreeDivision::RingOfOld(int v) const
{
  Ring ring;
  const Ring& old = this->Mesh.Rings[v];
  for (int i = 0; i < old.Count; ++i)
  {
    const int midpoint = this->MidpointAt(v, i);
    const bool isCutOff =
      midpoint != None && this->MidpointAt(v, i + 1 < old.Count ? i + 1 : 0) != None;
    Append(ring, midpoint);
    Append(ring, isCutOff ? None : this->CentroidOf(v, old.Item[i], old.Next(i)));
  }
  return ring;
}
}

SurfaceMesh Divide(const SurfaceMesh& mesh, const DivisionNumbers& numbers, const KeptEdges* kept,
  Executor& executor)
{
  SqrtThreeDivision division(mesh, numbers, kept);
  ForSpans(executor, mesh.Rings.size(), SpanSize,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        division.DivideAt(static_cast<int>(v));
      }
    });
  return division.Take();
}

SurfaceMesh Divide(const SurfaceMesh& mesh, const KeptEdges* kept, Executor& executor)
{
  return Divide(mesh, NumberForDivision(mesh, kept, executor), kept, executor);
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMesh.h"

#include "Core/Common/Grow.h"
#include "Core/Common/Refuse.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace volumic
{
bool SurfaceMesh::AreFarApart(int v, int w) const
{
  const Ring& first = this->Rings[v];
  const Ring& second = this->Rings[w];
  if (first.Contains(w))
  {
    return false;
  }
  for (int i = 0; i < first.Count; ++i)
  {
    if (second.Contains(first.Item[i]))
    {
      return false; // Two edges: nearly all that are near and no neighbours.
    }
  }
  for (int i = 0; i < first.Count; ++i)
  {
    const Ring& between = this->Rings[first.Item[i]];
    for (int j = 0; j < second.Count; ++j)
    {
      if (between.Contains(second.Item[j]))
      {
        return false;
      }
    }
  }
  return true;
}

int SurfaceMesh::AddVertex(const Vector& position, VertexPlaces* places)
{
  std::vector<int>& free = places ? places->Free : this->Free;
  if (free.empty())
  {
    Grow(this->Position, this->Position.size() + 1, Vector());
    Grow(this->Rings, this->Rings.size() + 1, Ring());
    free.push_back(this->Size() - 1);
  }
  const int v = free.back();
  free.pop_back();
  this->Position[v] = position;
  return v;
}

void SurfaceMesh::RemoveVertex(int v, VertexPlaces* places)
{
  this->Rings[v].Count = 0;
  (places ? places->Removed : this->Free).push_back(v);
}

void SurfaceMesh::Lend(VertexPlaces& places, std::size_t n)
{
  const std::size_t size = this->Rings.size();
  const std::size_t missing = n > this->Free.size() ? n - this->Free.size() : 0;
  Grow(this->Position, size + missing, Vector());
  Grow(this->Rings, size + missing, Ring());
  // The last of them is taken first.
  for (std::size_t i = missing; i > 0; --i)
  {
    places.Free.push_back(static_cast<int>(size + i - 1));
  }
  const auto first = this->Free.end() - static_cast<std::ptrdiff_t>(n - missing);
  places.Free.insert(places.Free.end(), first, this->Free.end());
  this->Free.erase(first, this->Free.end());
}

void SurfaceMesh::TakeBack(VertexPlaces& places)
{
  this->Free.insert(this->Free.end(), places.Free.begin(), places.Free.end());
  places.Free.clear();
}

void SurfaceMesh::TakeRemoved(VertexPlaces& places)
{
  this->Free.insert(this->Free.end(), places.Removed.begin(), places.Removed.end());
  places.Removed.clear();
}

int SurfaceMesh::NumberOfFaces() const
{
  std::int64_t ends = 0;
  for (const Ring& ring : this->Rings)
  {
    ends += ring.Count;
  }
  return static_cast<int>(ends / 3);
}

int SurfaceMesh::CountEulerCharacteristic() const
{
  // Every face has three half edges, every edge two: V - E + F = V - F / 2.
  return this->NumberOfVertices() - this->NumberOfFaces() / 2;
}

IndexedSurface SurfaceMesh::ToIndexed() const
{
  IndexedSurface surface;
  std::vector<int> place(this->Rings.size(), -1);
  surface.Points.reserve(this->NumberOfVertices());
  for (int v = 0; v < this->Size(); ++v)
  {
    if (this->IsAlive(v))
    {
      place[v] = static_cast<int>(surface.Points.size());
      const Vector& p = this->Position[v];
      surface.Points.push_back({ p.X, p.Y, p.Z });
    }
  }
  surface.Triangles.reserve(this->NumberOfFaces());
  this->VisitFaces([&](int a, int b, int c)
    { surface.Triangles.push_back({ place[a], place[b], place[c] }); });
  return surface;
}

namespace
{
using DirectedEdge = std::pair<int, int>;

/** For each vertex the directed edges (b, c) that its triangles have opposite to it. */
struct OppositeEdges
{
  std::vector<int> Start; ///< Of those of each vertex, and the end of the last.
  std::vector<DirectedEdge> Edges;

  explicit OppositeEdges(const IndexedSurface& surface) : Start(surface.Points.size() + 1, 0)
  {
    for (const Triangle& t : surface.Triangles)
    {
      for (int corner : t)
      {
        ++this->Start[corner + 1];
      }
    }
    std::partial_sum(this->Start.begin(), this->Start.end(), this->Start.begin());
    this->Edges.resize(this->Start.back());
    std::vector<int> fill(this->Start.begin(), this->Start.end() - 1);
    for (const Triangle& t : surface.Triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        this->Edges[fill[t[k]]++] = { t[(k + 1) % 3], t[(k + 2) % 3] };
      }
    }
  }
};

/** The ring that the edges opposite to a vertex make; changes their order. */
Ring RingOf(int vertex, DirectedEdge* edges, int count)
{
  if (count < 3)
  {
    Refuse("the surface is not closed: vertex ", vertex, " has ", count, " triangles");
  }
  if (count > Ring::Capacity)
  {
    Refuse(
      "vertex ", vertex, " of the surface has ", count, " neighbours, more than ", Ring::Capacity);
  }
  Ring ring;
  ring.Count = count;
  for (int i = 0; i < count; ++i)
  {
    ring.Item[i] = edges[i].first;
    // Bring the edge that begins where this one ends to the next place.
    for (int j = i + 1; j < count; ++j)
    {
      if (edges[j].first == edges[i].second)
      {
        std::swap(edges[i + 1], edges[j]);
        break;
      }
    }
    const bool follows = edges[(i + 1) % count].first == edges[i].second;
    const bool closesEarly = i + 1 < count && edges[i].second == edges[0].first;
    if (!follows || closesEarly)
    {
      Refuse("the surface is not a closed oriented manifold at vertex ", vertex);
    }
  }
  return ring;
}
}

int SurfaceMesh::Append(const IndexedSurface& surface)
{
  const int n = static_cast<int>(surface.Points.size());
  OppositeEdges opposite(surface);
  std::vector<Ring> rings(n); // Nothing is added before all is found to be sound.
  for (int v = 0; v < n; ++v)
  {
    const int start = opposite.Start[v];
    rings[v] = RingOf(v, opposite.Edges.data() + start, opposite.Start[v + 1] - start);
  }
  const int first = this->Size();
  for (int v = 0; v < n; ++v)
  {
    for (int i = 0; i < rings[v].Count; ++i)
    {
      rings[v].Item[i] += first;
    }
    const Point& p = surface.Points[v];
    this->Position.emplace_back(
      static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    this->Rings.push_back(rings[v]);
  }
  return first;
}

void SurfaceMesh::Reorder(const std::vector<int>& order)
{
  std::vector<int> place(this->Rings.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    place[order[i]] = static_cast<int>(i);
  }
  std::vector<Vector> position(order.size());
  std::vector<Ring> rings(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    position[i] = this->Position[order[i]];
    const Ring& from = this->Rings[order[i]];
    rings[i].Count = from.Count;
    for (int k = 0; k < from.Count; ++k)
    {
      rings[i].Item[k] = place[from.Item[k]];
    }
  }
  this->Position.swap(position);
  this->Rings.swap(rings);
  this->Free.clear();
}

void SurfaceMesh::Clear()
{
  this->Position.clear();
  this->Rings.clear();
  this->Free.clear();
}

namespace
{
/** Two zeros between the bits of a number of 21 bits, for a Morton code. */
std::uint64_t SpreadBits(std::uint64_t x)
{
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}
}

std::vector<int> SpaceFillingOrder(const SurfaceMesh& mesh, double cell)
{
  float low[3] = { std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
    std::numeric_limits<float>::max() };
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (mesh.IsAlive(v))
    {
      low[0] = std::min(low[0], mesh.Position[v].X);
      low[1] = std::min(low[1], mesh.Position[v].Y);
      low[2] = std::min(low[2], mesh.Position[v].Z);
    }
  }
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(mesh.NumberOfVertices());
  const auto bits = [cell](float x, float from)
  { return SpreadBits(static_cast<std::uint64_t>((x - from) / cell)); };
  for (int v = 0; v < mesh.Size(); ++v)
  {
    if (mesh.IsAlive(v))
    {
      const Vector& p = mesh.Position[v];
      keys.emplace_back(bits(p.X, low[0]) | bits(p.Y, low[1]) << 1 | bits(p.Z, low[2]) << 2, v);
    }
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  order.reserve(keys.size());
  for (const auto& key : keys)
  {
    order.push_back(key.second);
  }
  return order;
}
}

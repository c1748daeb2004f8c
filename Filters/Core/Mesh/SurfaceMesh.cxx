// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceMesh.h"

#include "Core/Common/Box.h"
#include "Core/Common/Grow.h"
#include "Core/Common/Sort.h"
#include "Core/Common/Spans.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
constexpr std::size_t VertexSpan = 8192;
}

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
      return false; // Two edges apart: the most frequent case.
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

int SurfaceMesh::AddVertex(const Vector& position, VertexSlots* slots)
{
  int v = this->Size();
  if (slots)
  {
    v = slots->Next++;
    ++slots->Added;
  }
  else
  {
    Grow(this->Position, this->Position.size() + 1, Vector());
    Grow(this->Rings, this->Rings.size() + 1, Ring());
  }
  this->Position[v] = position;
  return v;
}

void SurfaceMesh::RemoveVertex(int v, VertexSlots* slots)
{
  this->Rings[v].Count = 0;
  if (slots)
  {
    --slots->Added;
  }
  else
  {
    ++this->FreeSlots;
  }
}

std::int64_t SurfaceMesh::NumberOfFaces(Executor& executor) const
{
  const std::size_t ends = CountInSpans(executor, this->Rings.size(), VertexSpan,
    [this](std::size_t begin, std::size_t end)
    {
      std::size_t count = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        count += static_cast<std::size_t>(this->Rings[v].Count);
      }
      return count;
    });
  return static_cast<std::int64_t>(ends / 3);
}

int SurfaceMesh::CountEulerCharacteristic(Executor& executor) const
{
  // Each face has three half-edges, each edge two: V - E + F = V - F / 2.
  return static_cast<int>(this->NumberOfVertices() - this->NumberOfFaces(executor) / 2);
}

namespace
{
/** Return the number of alive vertices before each span, and the total. */
std::vector<std::size_t> FirstAlive(const SurfaceMesh& mesh, Executor& executor)
{
  return FirstOfSpans(executor, mesh.Rings.size(), VertexSpan,
    [rings = mesh.Rings.data()](std::size_t begin, std::size_t end)
    {
      return std::count_if(
        rings + begin, rings + end, [](const Ring& ring) { return ring.Count > 0; });
    });
}
}

IndexedSurface SurfaceMesh::ToIndexed(Executor& executor) const
{
  IndexedSurface surface;
  LargeVector<int> newIndex; // Allocated and written by threads.
  MakeZeroed(newIndex, this->Rings.size());
  const std::vector<std::size_t> firstPoint = FirstAlive(*this, executor);
  MakeZeroed(surface.Points, firstPoint.back());
  ForSpans(executor, this->Rings.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = firstPoint[span];
      for (std::size_t v = begin; v < end; ++v)
      {
        if (this->IsAlive(static_cast<int>(v)))
        {
          newIndex[v] = static_cast<int>(next);
          const Vector& p = this->Position[v];
          surface.Points[next++] = { p.X, p.Y, p.Z };
        }
      }
    });
  const std::vector<std::size_t> firstFace = FirstOfSpans(executor, this->Rings.size(), VertexSpan,
    [this](std::size_t begin, std::size_t end) { return this->CountFaces(begin, end); });
  MakeZeroed(surface.Triangles, firstFace.back());
  ForSpans(executor, this->Rings.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = firstFace[span];
      this->VisitFaces(begin, end,
        [&](int a, int b, int c) {
          surface.Triangles[next++] = { newIndex[a], newIndex[b], newIndex[c] };
        });
    });
  return surface;
}

void SurfaceMesh::Reorder(const std::vector<int>& order, Executor& executor)
{
  ReorderBuffers buffers;
  this->Reorder(order, buffers, executor);
}

void SurfaceMesh::Reorder(
  const std::vector<int>& order, ReorderBuffers& buffers, Executor& executor)
{
  const std::size_t n = order.size();
  this->FreeSlots = static_cast<int>(std::count(order.begin(), order.end(), NoVertex));
  volumic::Reorder(this->Position, order, buffers, executor);
  LargeVector<int> newIndex;
  MakeZeroed(newIndex, this->Rings.size());
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        if (order[i] != NoVertex)
        {
          newIndex[order[i]] = static_cast<int>(i);
        }
      }
    });
  LargeVector<Ring>& rings = buffers.ReorderBuffer<Ring>::Values;
  MakeRoom(rings, n);
  rings.resize(n);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        Ring& ring = rings[i];
        ring.Count = 0;
        if (order[i] != NoVertex)
        {
          const Ring& before = this->Rings[order[i]];
          ring.Count = before.Count;
          std::transform(before.Item, before.Item + before.Count, ring.Item,
            [&newIndex](int w) { return newIndex[w]; });
        }
      }
    });
  this->Rings.swap(rings);
}

void SurfaceMesh::Allocate(std::size_t n)
{
  this->Clear();
  MakeRoom(this->Position, n);
  MakeRoom(this->Rings, n);
  this->Position.resize(n);
  this->Rings.resize(n);
}

void SurfaceMesh::Clear()
{
  this->Position = {};
  this->Rings = {};
  this->FreeSlots = 0;
}

namespace
{
/** Insert two zeros between the bits of a 21-bit number, for a Morton code. */
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

/** Return the Z-order (Morton) code of a position, with cells of side `cell` from `low`. */
std::uint64_t MortonCode(const Vector& position, const Vector& low, double cell)
{
  const auto bits = [cell](float x, float from)
  { return SpreadBits(static_cast<std::uint64_t>((x - from) / cell)); };
  return bits(position.X, low.X) | bits(position.Y, low.Y) << 1 | bits(position.Z, low.Z) << 2;
}
}

std::vector<int> SpaceFillingOrder(const SurfaceMesh& mesh, double cell, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  constexpr float most = std::numeric_limits<float>::max();
  const Vector low = JoinVertices(
    mesh, executor, Vector(most, most, most),
    [&](int v, Vector& least)
    { least = mesh.IsAlive(v) ? Minimum(least, mesh.Position[v]) : least; },
    [](const Vector& a, const Vector& b) { return Minimum(a, b); });
  const std::vector<std::size_t> first = FirstAlive(mesh, executor);
  LargeVector<std::pair<std::uint64_t, int>> keys;
  MakeZeroed(keys, first.back());
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::size_t next = first[span];
      for (std::size_t v = begin; v < end; ++v)
      {
        if (mesh.IsAlive(static_cast<int>(v)))
        {
          keys[next++] = { MortonCode(mesh.Position[v], low, cell), static_cast<int>(v) };
        }
      }
    });
  Sort(executor, keys);
  std::vector<int> order(keys.size());
  ForSpans(executor, keys.size(), VertexSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        order[i] = keys[i].second;
      }
    });
  return order;
}
}

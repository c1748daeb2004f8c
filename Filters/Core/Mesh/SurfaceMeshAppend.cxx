// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// SurfaceMesh::Append.

#include "Core/Mesh/SurfaceMesh.h"

#include "Core/Common/Spans.h"
#include "Core/Common/ThrowInvalidArgument.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <utility>

namespace volumic
{
namespace
{
using DirectedEdge = std::pair<int, int>;

constexpr std::size_t VertexSpan = 8192;

/** Triangle corners at each point of a surface. */
class CornersOfPoints
{
public:
  CornersOfPoints(const IndexedSurface& surface, Executor& executor)
    : Surface(surface), Remaining(surface.Points.size()), Start(surface.Points.size() + 1, 0),
      Corners(3 * surface.Triangles.size())
  {
    const auto forCorners = [&](auto&& visit)
    {
      ForSpans(executor, surface.Triangles.size(), 2 * VertexSpan,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
          for (std::size_t t = begin; t < end; ++t)
          {
            for (int k = 0; k < 3; ++k)
            {
              visit(surface.Triangles[t][k], static_cast<int>(3 * t) + k);
            }
          }
        });
    };
    forCorners(
      [this](int point, int) { this->Remaining[point].fetch_add(1, std::memory_order_relaxed); });
    for (std::size_t p = 0; p < this->Remaining.size(); ++p)
    {
      this->Start[p + 1] = this->Start[p] + this->Remaining[p].load(std::memory_order_relaxed);
    }
    forCorners(
      [this](int point, int corner)
      {
        const int last = this->Remaining[point].fetch_sub(1, std::memory_order_relaxed) - 1;
        this->Corners[this->Start[point] + last] = corner;
      });
  }

  int Count(std::size_t point) const { return this->Start[point + 1] - this->Start[point]; }

  /** Find the edges opposite to a point, in the order of the triangles for any executor. */
  void FindOppositeEdges(std::size_t point, std::vector<DirectedEdge>& edges)
  {
    std::sort(
      this->Corners.begin() + this->Start[point], this->Corners.begin() + this->Start[point + 1]);
    edges.clear();
    for (int i = this->Start[point]; i < this->Start[point + 1]; ++i)
    {
      const Triangle& t = this->Surface.Triangles[this->Corners[i] / 3];
      const int k = this->Corners[i] % 3;
      edges.emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    }
  }

private:
  const IndexedSurface& Surface;
  LargeVector<std::atomic<int>> Remaining; ///< By point: corners not stored yet.
  LargeVector<int> Start;                  ///< By point: index of its first corner in Corners.
  LargeVector<int> Corners;                ///< 3 x triangle + index in it.
};

/** Return the ring of a vertex from the edges opposite to it. `edges` is a buffer. */
Ring RingOf(int vertex, CornersOfPoints& corners, std::vector<DirectedEdge>& edges)
{
  const int count = corners.Count(static_cast<std::size_t>(vertex));
  if (count < 3)
  {
    ThrowInvalidArgument(
      "the surface is not closed: vertex ", vertex, " has ", count, " triangles. Fill its holes.");
  }
  if (count > Ring::Capacity)
  {
    ThrowInvalidArgument("vertex ", vertex, " of the surface has ", count,
      " neighbours, but at most ", Ring::Capacity, " are supported. Remesh the surface.");
  }
  corners.FindOppositeEdges(static_cast<std::size_t>(vertex), edges);
  Ring ring;
  ring.Count = count;
  for (int i = 0; i < count; ++i)
  {
    ring.Item[i] = edges[i].first;
    // Move the edge that begins where this one ends to the next position.
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
      ThrowInvalidArgument(
        "the surface is not a closed oriented manifold at vertex ", vertex, ". Repair it.");
    }
  }
  return ring;
}
}

int SurfaceMesh::Append(const IndexedSurface& surface, Executor& executor)
{
  const std::size_t n = surface.Points.size();
  CornersOfPoints corners(surface, executor);
  const int first = this->Size();
  LargeVector<Ring> rings(n); // The mesh changes only if the whole surface is valid.
  const auto find = [&](std::size_t begin, std::size_t end)
  {
    std::vector<DirectedEdge> edges;
    for (std::size_t v = begin; v < end; ++v)
    {
      rings[v] = RingOf(static_cast<int>(v), corners, edges);
      for (int i = 0; i < rings[v].Count; ++i)
      {
        rings[v].Item[i] += first;
      }
    }
  };
  std::vector<std::exception_ptr> faults((n + VertexSpan - 1) / VertexSpan);
  ForSpans(executor, n, VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      try
      {
        find(begin, end);
      }
      catch (...)
      {
        faults[span] = std::current_exception();
      }
    });
  for (const std::exception_ptr& fault : faults)
  {
    if (fault)
    {
      std::rethrow_exception(fault); // First by index: does not depend on the executor.
    }
  }
  this->Position.resize(this->Position.size() + n);
  for (std::size_t v = 0; v < n; ++v)
  {
    const Point& p = surface.Points[v];
    this->Position[static_cast<std::size_t>(first) + v] =
      Vector(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  this->Rings.insert(this->Rings.end(), rings.begin(), rings.end());
  return first;
}
}

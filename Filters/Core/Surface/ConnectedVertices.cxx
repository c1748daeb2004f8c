// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/ConnectedVertices.h"

#include "Core/Common/Spans.h"

#include <algorithm>
#include <cstddef>

namespace volumic
{
namespace
{
/** Vertices that one thread joins at a time. */
constexpr std::size_t JoinedSpan = 4096;

/** Of a root, while the others of its set still bear its index; no index. */
constexpr int MarkOfRoot(int label)
{
  return -2 - label;
}

/** Where a neighbour is, seen from a vertex of a span. */
enum class Side
{
  Later, ///< It sees to the edge between them itself.
  SameSpan,
  SpanBefore
};
}

void ConnectedVertices::Label(
  const SurfaceMesh& mesh, LargeVector<int>& labels, Executor& executor)
{
  const std::size_t n = mesh.Rings.size();
  this->JoinVertices(mesh, executor);
  // Roots first: they are the smallest of their set, and numbered in their order.
  const std::vector<std::size_t> first = FirstOfSpans(executor, n, JoinedSpan,
    [&](std::size_t begin, std::size_t end)
    {
      std::size_t roots = 0;
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (mesh.IsAlive(v))
        {
          labels[v] = this->Joined.FindRoot(v);
          roots += labels[v] == v;
        }
      }
      return roots;
    });
  this->SmallestOnes.resize(first.back());
  ForSpans(executor, n, JoinedSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      std::size_t label = first[b];
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (labels[v] == v && mesh.IsAlive(v))
        {
          labels[v] = MarkOfRoot(static_cast<int>(label));
          this->SmallestOnes[label++] = v;
        }
      }
    });
  ForSpans(executor, n, JoinedSpan,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (labels[v] >= 0 && mesh.IsAlive(v))
        {
          labels[v] = MarkOfRoot(labels[labels[v]]); // Its own inverse.
        }
      }
    });
  for (std::size_t label = 0; label < this->SmallestOnes.size(); ++label)
  {
    labels[this->SmallestOnes[label]] = static_cast<int>(label);
  }
}

void ConnectedVertices::JoinVertices(
  const SurfaceMesh& mesh, Executor& executor)
{
  // First within spans, side by side, then across their borders.
  const std::size_t n = mesh.Rings.size();
  this->Joined.MakeRoom(n);
  this->Borders.resize((n + JoinedSpan - 1) / JoinedSpan);
  ForSpans(executor, n, JoinedSpan,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      this->Borders[b].clear();
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (!mesh.IsAlive(v))
        {
          continue;
        }
        this->Joined.MakeSet(v);
        int root = v;
        const Ring& ring = mesh.Rings[v];
        Side before = Side::Later;
        for (int i = 0; i < ring.Count; ++i)
        {
          // Neighbours next to each other are neighbours themselves: on one side one is enough.
          const int w = ring.Item[i];
          const Side side = w >= v         ? Side::Later
            : w >= static_cast<int>(begin) ? Side::SameSpan
                                           : Side::SpanBefore;
          if (side == Side::SpanBefore && side != before)
          {
            this->Borders[b].emplace_back(v, w);
          }
          else if (side == Side::SameSpan && side != before)
          {
            root = this->Joined.Join(root, w);
          }
          before = side;
        }
      }
    });
  // Of the many edges between the same two sets one is enough.
  ForSpans(executor, this->Borders.size(), 1,
    [this](std::size_t b, std::size_t, std::size_t)
    {
      std::vector<std::pair<int, int>>& border = this->Borders[b];
      for (auto& edge : border)
      {
        edge = { this->Joined.FindRoot(edge.first), this->Joined.FindRoot(edge.second) };
      }
      std::sort(border.begin(), border.end());
      border.erase(std::unique(border.begin(), border.end()), border.end());
    });
  for (const auto& border : this->Borders)
  {
    for (const auto& edge : border)
    {
      this->Joined.Join(edge.first, edge.second);
    }
  }
}
}

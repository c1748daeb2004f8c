// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The way of a surface to the next level's edge lengths.

#include "Core/Common/Spans.h"
#include "Core/Evolution/EdgesToKeep.h"
#include "Core/Evolution/Evolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 8192;
/** Sweeps of a descent, and passes in each block; more make no difference to what comes after. */
constexpr int DescendingSweeps = 2;
constexpr int DescendingPasses = 2;
/** Of what is told of a division. */
constexpr double DescendingShare = 0.3;

/**
 * Calls visit(v, w, squared length) for each edge whose smaller end is in a span; spans may be
 * visited side by side.
 */
template <typename Visit>
void VisitEdges(const SurfaceMesh& mesh, std::size_t begin, std::size_t end, const Visit& visit)
{
  for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
  {
    const Ring& ring = mesh.Rings[v];
    for (int i = 0; i < ring.Count; ++i)
    {
      const int w = ring.Item[i];
      if (v < w)
      {
        visit(v, w, SquaredDistance(mesh.Position[v], mesh.Position[w]));
      }
    }
  }
}

float LongestEdge(const Evolution& e)
{
  const SurfaceMesh& mesh = e.State.Mesh;
  std::vector<float> longest((mesh.Rings.size() + VertexSpan - 1) / VertexSpan, 0.f);
  ForSpans(e.Threads, mesh.Rings.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      VisitEdges(mesh, begin, end, [&](int, int, float squared)
        { longest[span] = std::max(longest[span], squared); });
    });
  return std::sqrt(std::accumulate(longest.begin(), longest.end(), 0.f,
    [](float most, float ofSpan) { return std::max(most, ofSpan); }));
}

std::vector<Proximity::FacePair> FindIntersections(Evolution& e)
{
  // A division leaves some edges longer than verification may rely on; it looks further for them.
  SurfaceState& s = e.State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(LongestEdge(e));
  LayGrid(e);
  const std::vector<Proximity::FacePair> found =
    Proximity::FindIntersections(s, AliveVertices(e), e.Threads);
  s.Sizing = sizing;
  return found;
}

void DivideOnce(Evolution& e)
{
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are kept, then more and more about them, and all of them at last, which
  // leaves the old surface, with more vertices.
  ForgetBlocks(e);
  SurfaceMesh old = std::exchange(e.State.Mesh, SurfaceMesh());
  old.Reorder(SpaceFillingOrder(old, e.State.Sizing.Smallest(), e.Threads), e.Threads);
  std::unique_ptr<KeptEdges> kept;
  for (int round = 0; round <= EdgesToKeep::Rounds; ++round)
  {
    const DivisionNumbers numbers = NumberForDivision(old, kept.get(), e.Threads);
    e.State.Mesh = volumic::Divide(old, numbers, kept.get(), e.Threads);
    const std::vector<Proximity::FacePair> found = FindIntersections(e);
    if (found.empty() || round == EdgesToKeep::Rounds)
    {
      return;
    }
    if (!kept)
    {
      kept = std::make_unique<KeptEdges>(old);
    }
    EdgesToKeep(old, numbers, *kept).KeepAbout(found, round);
  }
}
}

void DescendField(Evolution& e, double delta)
{
  const SizingField sizing = e.State.Sizing;
  e.State.Sizing = SizingField(static_cast<float>(delta));
  Renumber(e); // In an order that does not depend on what has been done before.
  ActivateAll(e);
  for (int sweep = 0; sweep < DescendingSweeps && !e.Stopped; ++sweep)
  {
    Relax(e, SurfaceIteration::Mode::Descend, DescendingPasses,
      { Monitor::Activity::Dividing, DescendingShare * sweep / DescendingSweeps,
        DescendingShare * (sweep + 1) / DescendingSweeps });
  }
  ForgetBlocks(e);
  e.State.Sizing = sizing;
  e.HasDescended = true;
}

bool DivideAll(Evolution& e, int divisions)
{
  bool goesOn = true;
  for (int i = 0; i < divisions && goesOn; ++i)
  {
    DivideOnce(e);
    goesOn = e.GoOn(Monitor::Activity::Dividing, (i + 1.) / divisions);
  }
  if (divisions > 0)
  {
    LayOut(e);
  }
  else
  {
    Renumber(e);
  }
  return goesOn;
}

bool HasEdgeTooLong(const Evolution& e)
{
  constexpr float share = 1.0001f; // Of the longest that eq. (1) allows.
  const SurfaceMesh& mesh = e.State.Mesh;
  return CountInSpans(e.Threads, mesh.Rings.size(), VertexSpan,
           [&](std::size_t begin, std::size_t end)
           {
             std::size_t count = 0;
             VisitEdges(mesh, begin, end, [&](int v, int w, float squared)
               { count += std::sqrt(squared) > e.State.Sizing.LongestEdge(v, w, share); });
             return count;
           }) > 0;
}
}

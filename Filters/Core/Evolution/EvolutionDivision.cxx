// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The way of a surface to the next level's edge lengths.

#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/EdgesToKeep.h"
#include "Core/Evolution/EvolutionImplementation.h"

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

/** Whether an edge is longer than this share of the longest that eq. (1) allows. */
bool HasEdgeOver(const SurfaceState& state, float share, Executor& executor)
{
  const SurfaceMesh& mesh = state.Mesh;
  return CountInSpans(executor, mesh.Rings.size(), VertexSpan,
           [&](std::size_t begin, std::size_t end)
           {
             std::size_t count = 0;
             VisitEdges(mesh, begin, end, [&](int v, int w, float squared)
               { count += std::sqrt(squared) > state.Sizing.LongestEdge(v, w, share); });
             return count;
           }) > 0;
}
}

float SurfaceEvolution::Implementation::LongestEdge() const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  std::vector<float> longest((mesh.Rings.size() + VertexSpan - 1) / VertexSpan, 0.f);
  ForSpans(this->Threads, mesh.Rings.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      VisitEdges(mesh, begin, end, [&](int, int, float squared)
        { longest[span] = std::max(longest[span], squared); });
    });
  return std::sqrt(std::accumulate(longest.begin(), longest.end(), 0.f,
    [](float most, float ofSpan) { return std::max(most, ofSpan); }));
}

std::vector<Proximity::FacePair> SurfaceEvolution::Implementation::FindIntersections()
{
  // A division leaves some edges longer than verification may rely on; it looks further for them.
  SurfaceState& s = this->State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(this->LongestEdge());
  this->LayGrid();
  const std::vector<Proximity::FacePair> found =
    Proximity::FindIntersections(s, this->AliveVertices(), this->Threads);
  s.Sizing = sizing;
  return found;
}

void SurfaceEvolution::Implementation::DescendField(double delta)
{
  const SizingField sizing = this->State.Sizing;
  this->State.Sizing = SizingField(static_cast<float>(delta));
  this->Reset(); // In an order that does not depend on what has been done before.
  this->ActivateAll();
  const Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  for (int sweep = 0; sweep < DescendingSweeps && !this->Stopped; ++sweep)
  {
    this->VisitAll(SurfaceIteration::Mode::Descend, dynamics, DescendingPasses,
      Monitor::Activity::Dividing, DescendingShare * sweep / DescendingSweeps,
      DescendingShare * (sweep + 1) / DescendingSweeps);
  }
  this->ForgetBlocks();
  this->State.Sizing = sizing;
  this->HasDescended = true;
}

void SurfaceEvolution::Implementation::DivideOnce()
{
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are kept, then more and more about them, and all of them at last, which
  // leaves the old surface, with more vertices.
  this->ForgetBlocks();
  SurfaceMesh old = std::exchange(this->State.Mesh, SurfaceMesh());
  old.Reorder(
    SpaceFillingOrder(old, this->State.Sizing.Smallest(), this->Threads), this->Threads);
  std::unique_ptr<KeptEdges> kept;
  for (int round = 0; round <= EdgesToKeep::Rounds; ++round)
  {
    const DivisionNumbers numbers = NumberForDivision(old, kept.get(), this->Threads);
    this->State.Mesh = volumic::Divide(old, numbers, kept.get(), this->Threads);
    const std::vector<Proximity::FacePair> found = this->FindIntersections();
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

bool SurfaceEvolution::Implementation::DivideAll(int divisions)
{
  bool goesOn = true;
  for (int i = 0; i < divisions && goesOn; ++i)
  {
    this->DivideOnce();
    goesOn = this->GoOn(Monitor::Activity::Dividing, (i + 1.) / divisions);
  }
  if (divisions > 0)
  {
    this->LayOut();
  }
  else
  {
    this->Reset();
  }
  return goesOn;
}

bool SurfaceEvolution::Implementation::HasEdgeTooLong() const
{
  return HasEdgeOver(this->State, 1.0001f, this->Threads);
}

std::vector<int> SurfaceEvolution::Implementation::AliveVertices() const
{
  return SelectIndices(this->Threads, this->State.Mesh.Rings.size(),
    [this](std::size_t v) { return this->State.Mesh.IsAlive(static_cast<int>(v)); });
}
}

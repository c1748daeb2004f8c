// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The way of a surface to the next level's edge lengths, on one rank or on all.

#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Mesh/Division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexSpan = 8192;
/** Rounds in which more and more edges are kept, until none is flipped in the last. */
constexpr int KeepingRounds = 6;

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
      if (v < w && mesh.IsAlive(w)) // Else at the rim of what is here of it.
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

/** Keeps the edges whose flips made the face; from the second round on others about it, too. */
void KeepAbout(const std::array<int, 3>& face, const LargeVector<Triangle>& faces,
  const SurfaceMesh& old, int round, KeptEdges& kept)
{
  const int olds = old.Size();
  const int centres = olds + static_cast<int>(faces.size());
  const auto isCentre = [=](int v) { return v >= olds && v < centres; };
  std::vector<int> about;
  for (int k = 0; k < 3; ++k)
  {
    if (!isCentre(face[k]))
    {
      continue;
    }
    const std::array<int, 3>& own = faces[face[k] - olds];
    about.insert(about.end(), own.begin(), own.end());
    const int next = face[(k + 1) % 3];
    if (isCentre(next))
    {
      const std::array<int, 3>& other = faces[next - olds];
      for (int i = 0; i < 3; ++i)
      {
        const auto has = [&other](int v)
        { return std::find(other.begin(), other.end(), v) != other.end(); };
        if (has(own[i]) && has(own[(i + 1) % 3]))
        {
          kept.Keep(own[i], own[(i + 1) % 3]);
        }
      }
    }
  }
  for (int ring = 0; ring < round; ++ring)
  {
    std::sort(about.begin(), about.end());
    about.erase(std::unique(about.begin(), about.end()), about.end());
    for (std::size_t i = 0, n = about.size(); i < n; ++i)
    {
      kept.KeepAllAt(about[i]);
      const Ring& neighbours = old.Rings[about[i]];
      about.insert(about.end(), neighbours.Item, neighbours.Item + neighbours.Count);
    }
  }
}
}

float SurfaceEvolution::Implementation::LongestEdge()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  std::vector<float> longest((mesh.Rings.size() + VertexSpan - 1) / VertexSpan, 0.f);
  ForSpans(this->Threads, mesh.Rings.size(), VertexSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      VisitEdges(mesh, begin, end, [&](int, int, float squared)
        { longest[span] = std::max(longest[span], squared); });
    });
  float most = 0.f;
  for (const float ofSpan : longest)
  {
    most = std::max(most, ofSpan);
  }
  for (const float ofRank : GatherValues(this->Sharers(), most))
  {
    most = std::max(most, ofRank);
  }
  return std::sqrt(most);
}

std::vector<Proximity::FacePair> SurfaceEvolution::Implementation::FindIntersections()
{
  // A division leaves some edges longer than verification may rely on; it looks further for them.
  SurfaceState& s = this->State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(this->LongestEdge());
  this->LayGrid();
  const std::vector<Proximity::FacePair> found =
    Proximity::FindIntersections(s, this->OwnVertices(), this->Threads);
  s.Sizing = sizing;
  return found;
}

void SurfaceEvolution::Implementation::KeepEdgesAbout(
  const std::vector<Proximity::FacePair>& pairs, const LargeVector<Triangle>& faces,
  const SurfaceMesh& old, int round, KeptEdges& kept)
{
  for (const Proximity::FacePair& pair : pairs)
  {
    KeepAbout(pair.First, faces, old, round, kept);
    KeepAbout(pair.Second, faces, old, round, kept);
  }
  if (round == KeepingRounds - 1)
  {
    kept.KeepAll();
  }
  kept.MakeRoom();
}

void SurfaceEvolution::Implementation::DivideOnce()
{
  SurfaceState& s = this->State;
  this->ForgetBlocks();
  s.Mesh.Reorder(
    SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), this->Threads), this->Threads);
  const int olds = s.Mesh.Size();
  this->Threads.EndPhase("Order");
  const LargeVector<Triangle> faces = volumic::Divide(s.Mesh, nullptr, this->Threads);
  this->Threads.EndPhase("Division");
  std::vector<Proximity::FacePair> intersections = this->FindIntersections();
  if (intersections.empty())
  {
    return;
  }
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are kept, then more and more about them, and all of them at last, which
  // leaves the old surface, with more vertices.
  const SurfaceMesh old = Undivided(s.Mesh, olds, this->Threads);
  KeptEdges kept(old);
  for (int round = 0; round < KeepingRounds && !intersections.empty(); ++round)
  {
    this->KeepEdgesAbout(intersections, faces, old, round, kept);
    s.Mesh = old;
    volumic::Divide(s.Mesh, &kept, this->Threads);
    intersections = this->FindIntersections();
  }
}

bool SurfaceEvolution::Implementation::DivideWhole(int divisions)
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

void SurfaceEvolution::Implementation::LayGridOfPiece()
{
  SurfaceState& s = this->State;
  const std::size_t n = s.Mesh.Rings.size();
  s.Grid.Reset(this->GridLow, this->GridHigh, s.Sizing.SmallestReach());
  s.Grid.Lengthen(n);
  std::vector<int> here; // With all their neighbours: others' shape is theirs to know.
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      s.Grid.Insert(v, s.Mesh.Position[v]);
      const Ring& ring = s.Mesh.Rings[v];
      if (std::all_of(ring.Item, ring.Item + ring.Count, [&s](int w) { return s.Mesh.IsAlive(w); }))
      {
        here.push_back(v);
      }
    }
  }
  s.UpdateShape(here, this->Threads);
}

std::vector<int> SurfaceEvolution::Implementation::OwnVertices() const
{
  return SelectIndices(this->Threads, this->State.Mesh.Rings.size(),
    [this](std::size_t i)
    {
      const int v = static_cast<int>(i);
      return this->State.Mesh.IsAlive(v) && (!this->Piece || this->Piece->IsOwnVertex(v));
    });
}

std::vector<Proximity::FacePair> SurfaceEvolution::Implementation::FindIntersectionsInPieces()
{
  SurfaceState& s = this->State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(this->LongestEdge());
  this->LayGridOfPiece();
  const std::vector<int> own = this->OwnVertices();
  const std::vector<Proximity::FacePair> found =
    Proximity::FindIntersections(s, own, this->Threads);
  for (const int v : own)
  {
    // What was found of them is not known of those that other ranks own.
    s.Slack[v] = 0.f;
    s.NearOthers[v] = 1;
  }
  s.Sizing = sizing;
  this->LayGridOfPiece();
  return GatherListsOnAll(this->Sharers(), found);
}

void SurfaceEvolution::Implementation::SpreadMesh()
{
  // One that is whole on rank 0, and of which nothing is known but the mesh.
  SurfaceState& s = this->State;
  const SurfaceMesh whole = std::exchange(s.Mesh, SurfaceMesh());
  this->FindGridBox(whole);
  this->AgreeOnGridBox();
  if (!this->IsInPieces())
  {
    this->ShareBlocks(whole);
  }
  this->Piece->Scatter(whole, this->GridLow, this->GridHigh);
}

void SurfaceEvolution::Implementation::DivideInPieces()
{
  SurfaceState& s = this->State;
  this->ForgetBlocks();
  SurfaceMesh old;
  std::unique_ptr<KeptEdges> kept;
  for (int round = 0; round <= KeepingRounds; ++round)
  {
    LargeVector<Triangle> faces;
    if (this->IsFirstRank())
    {
      if (round == 0)
      {
        s.Mesh.Reorder(
          SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), this->Threads), this->Threads);
        old = s.Mesh;
      }
      else
      {
        s.Mesh = old;
      }
      faces = volumic::Divide(s.Mesh, round > 0 ? kept.get() : nullptr, this->Threads);
    }
    this->SpreadMesh();
    const std::vector<Proximity::FacePair> found = this->FindIntersectionsInPieces();
    if (found.empty())
    {
      return;
    }
    if (this->IsFirstRank())
    {
      if (!kept)
      {
        kept = std::make_unique<KeptEdges>(old);
      }
      this->KeepEdgesAbout(found, faces, old, round, *kept);
    }
  }
}

void SurfaceEvolution::Implementation::SpreadWhole()
{
  this->ForgetBlocks();
  if (this->IsFirstRank())
  {
    this->State.Mesh.Reorder(
      SpaceFillingOrder(this->State.Mesh, this->State.Sizing.Smallest(), this->Threads),
      this->Threads);
  }
  this->SpreadMesh();
  this->LayGridOfPiece();
}

bool SurfaceEvolution::Implementation::LayOutInPieces(int divisions)
{
  // All but the last division are rank 0's, which has the whole.
  bool goesOn = true;
  for (int i = 0; i < divisions - 1 && goesOn; ++i)
  {
    if (this->IsFirstRank())
    {
      this->DivideOnce();
    }
    goesOn = !this->Ranks->IsAny(!this->GoOn(Monitor::Activity::Dividing, (i + 1.) / divisions));
  }
  if (goesOn && divisions > 0)
  {
    this->DivideInPieces();
  }
  else
  {
    this->SpreadWhole();
  }
  this->Threads.EndPhase("Division");
  this->SplitLongEdges();
  return goesOn;
}
}

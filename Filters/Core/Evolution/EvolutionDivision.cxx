// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The way of a surface to the next level's edge lengths, on one rank or on all.

#include "Core/Common/RankLists.h"
#include "Core/Common/Select.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/EdgesToKeep.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/MeshPiece.h"

#include <algorithm>
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

MeshPiece SurfaceEvolution::Implementation::TakePiece(Communicator& ranks)
{
  const double cell = this->State.Sizing.Smallest();
  MeshPiece piece;
  if (ranks.NumberOfRanks() == 1)
  {
    this->ForgetBlocks();
    piece = RenumberWhole(std::exchange(this->State.Mesh, SurfaceMesh()), cell, this->Threads);
  }
  else
  {
    piece = RenumberOnRanks(
      ranks, this->State.Mesh, this->OwnVertices(), cell, this->Threads);
    this->ForgetBlocks();
    this->OwnAtRest.reset();
    this->State.Mesh = SurfaceMesh();
  }
  this->Threads.EndPhase("Order");
  return piece;
}

void SurfaceEvolution::Implementation::DivideOnce(Communicator& ranks, int divisionsToCome)
{
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are kept, then more and more about them, and all of them at last, which
  // leaves the old surface, with more vertices.
  const bool isWhole = ranks.NumberOfRanks() == 1;
  const MeshPiece piece = this->TakePiece(ranks);
  std::unique_ptr<KeptEdges> kept;
  for (int round = 0; round <= EdgesToKeep::Rounds; ++round)
  {
    const DivisionNumbers numbers =
      NumberForDivision(ranks, piece, kept.get(), this->Threads);
    SurfaceMesh divided =
      volumic::Divide(piece.Mesh, piece.Own, numbers, kept.get(), this->Threads);
    this->Threads.EndPhase("Division");
    if (isWhole)
    {
      this->State.Mesh = std::move(divided);
    }
    else
    {
      this->SpreadMesh(
        std::move(divided), DividedOf(piece, numbers, kept.get()), divisionsToCome);
    }
    const std::vector<Proximity::FacePair> found =
      isWhole ? this->FindIntersections() : this->FindIntersectionsInPieces();
    if (found.empty() || round == EdgesToKeep::Rounds)
    {
      return;
    }
    if (!kept)
    {
      kept = std::make_unique<KeptEdges>(piece.Mesh);
    }
    EdgesToKeep(ranks, piece, numbers, *kept).KeepAbout(found, round);
  }
}

bool SurfaceEvolution::Implementation::DivideWhole(int divisions)
{
  bool goesOn = true;
  for (int i = 0; i < divisions && goesOn; ++i)
  {
    this->DivideOnce(OnThisRank(), divisions - 1 - i);
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
  if (this->OwnAtRest)
  {
    return *this->OwnAtRest;
  }
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

void SurfaceEvolution::Implementation::SpreadMesh(
  SurfaceMesh mesh, const std::vector<int>& own, int divisionsToCome)
{
  this->FindGridBox(mesh, own);
  // Blocks and halos are those of the edges as they are now.
  SurfaceState& s = this->State;
  const SizingField sizing = s.Sizing;
  s.Sizing = SizingField(static_cast<float>(
    sizing.OfLevel() * std::pow(SizingField::DivisionFactor, divisionsToCome)));
  if (!this->IsInPieces())
  {
    this->MakeBlocks(*this->Ranks);
    this->Piece->ChooseOwners(mesh, own);
    if (this->Voxels && divisionsToCome == 0)
    {
      // Blocks that have been chosen first fill a box.
      const VoxelBox share = this->Piece->RowsOf(this->TheField->Image());
      VoxelBox needed = share;
      for (const VoxelBox& row : this->OwnVoxels())
      {
        needed = needed.With(row);
      }
      this->Voxels({ needed }, share);
    }
  }
  this->Piece->Scatter(mesh, own, this->GridLow, this->GridHigh);
  s.Sizing = sizing;
}

bool SurfaceEvolution::Implementation::LayOutInPieces(int divisions)
{
  bool goesOn = true;
  for (int i = 0; i < divisions && goesOn; ++i)
  {
    this->DivideOnce(*this->Ranks, divisions - 1 - i);
    goesOn = i + 1 == divisions ||
      !this->Ranks->IsAny(!this->GoOn(Monitor::Activity::Dividing, (i + 1.) / divisions));
  }
  if (!goesOn || divisions == 0)
  {
    MeshPiece piece = this->TakePiece(*this->Ranks);
    this->SpreadMesh(std::move(piece.Mesh), piece.Own, 0);
    this->LayGridOfPiece();
  }
  this->Threads.EndPhase("Division");
  this->SplitLongEdges();
  return goesOn;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Blocks.h"
#include "Core/Common/Box.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/LostParts.h"
#include "Core/Mesh/Division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexBlock = 8192;

/**
 * Calls visit(v, w, squared length) for each edge whose smaller end is in a block; blocks may be
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

float LongestEdge(const SurfaceMesh& mesh, Executor& executor)
{
  std::vector<float> longest((mesh.Rings.size() + VertexBlock - 1) / VertexBlock, 0.f);
  ForBlocks(executor, mesh.Rings.size(), VertexBlock,
    [&](std::size_t block, std::size_t begin, std::size_t end)
    {
      VisitEdges(mesh, begin, end, [&](int, int, float squared)
        { longest[block] = std::max(longest[block], squared); });
    });
  float most = 0.f;
  for (const float ofBlock : longest)
  {
    most = std::max(most, ofBlock);
  }
  return std::sqrt(most);
}

/** Whether an edge is longer than this share of the longest that eq. (1) allows. */
bool HasEdgeOver(const SurfaceState& state, float share, Executor& executor)
{
  const SurfaceMesh& mesh = state.Mesh;
  return CountInBlocks(executor, mesh.Rings.size(), VertexBlock,
           [&](std::size_t begin, std::size_t end)
           {
             std::size_t count = 0;
             VisitEdges(mesh, begin, end, [&](int v, int w, float squared)
               { count += std::sqrt(squared) > state.Sizing.LongestEdge(v, w, share); });
             return count;
           }) > 0;
}
}

void SurfaceEvolution::Implementation::Enter(const LevelImage& image, int level)
{
  this->TheField = std::make_unique<Field>(image, this->Options, this->Threads);
  this->State.Margin = this->TheField->Margin();
  this->Level = level;
  this->LastIterations = 0;
  this->Visit = {};
  this->InSweeps = false;
  this->State.Sizing = SizingField(static_cast<float>(this->Options.SamplingRatio * image.Unit));
}

void SurfaceEvolution::Implementation::Reset()
{
  SurfaceState& s = this->State;
  this->DecideOnSweeps();
  s.Mesh.Reorder(
    SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), this->Threads), this->Threads);
  this->Threads.EndPhase("Order");
  this->LayGrid();
  this->Threads.EndPhase("Grid");
  this->SplitLongEdges();
  this->Threads.EndPhase("Long edges");
  if (!this->InSweeps) // Else each visit examines its own.
  {
    this->Iteration.Examine();
    this->Threads.EndPhase("Proximity");
  }
  this->Iteration.LabelComponents();
  this->Threads.EndPhase("Labels");
}

void SurfaceEvolution::Implementation::SplitLongEdges()
{
  // Verification relies on it that no edge is longer than the constraints allow.
  this->Iteration.UpdateActive();
  this->Iteration.SplitLongEdges();
  if (HasEdgeOver(this->State, 1.0001f, this->Threads))
  {
    // Full rings all about it: not seen yet.
    this->TakeRemeshed(this->State.Mesh.ToIndexed(this->Threads));
  }
}

void SurfaceEvolution::Implementation::LayGrid()
{
  SurfaceState& s = this->State;
  const LevelImage& image = this->TheField->Image();
  Vector low(0, 0, 0);
  Vector high(static_cast<float>(image.Size[0] * image.Step[0]),
    static_cast<float>(image.Size[1] * image.Step[1]),
    static_cast<float>(image.Size[2] * image.Step[2]));
  const std::size_t blocks = (s.Mesh.Position.size() + VertexBlock - 1) / VertexBlock;
  std::vector<Vector> lows(blocks, low);
  std::vector<Vector> highs(blocks, high);
  ForBlocks(this->Threads, s.Mesh.Position.size(), VertexBlock,
    [&](std::size_t block, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        lows[block] = Minimum(lows[block], s.Mesh.Position[v]);
        highs[block] = Maximum(highs[block], s.Mesh.Position[v]);
      }
    });
  for (std::size_t block = 0; block < blocks; ++block)
  {
    low = Minimum(low, lows[block]);
    high = Maximum(high, highs[block]);
  }
  const float delta = s.Sizing.Largest();
  const Vector margin(2 * delta, 2 * delta, 2 * delta);
  this->Iteration.Forget();
  this->GridLow = low - margin;
  this->GridHigh = high + margin;
  s.Reset(this->GridLow, this->GridHigh, this->Threads);
}

namespace
{
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

std::vector<Proximity::FacePair> SurfaceEvolution::Implementation::FindIntersections()
{
  // A division leaves some edges longer than verification may rely on; it looks further for them.
  SurfaceState& s = this->State;
  const SizingField sizing = s.Sizing;
  s.Sizing = sizing.ForEdgesOf(LongestEdge(s.Mesh, this->Threads));
  this->LayGrid();
  this->Iteration.UpdateActive();
  const std::vector<Proximity::FacePair> found = this->Iteration.FindIntersections();
  s.Sizing = sizing;
  return found;
}

void SurfaceEvolution::Implementation::DivideOnce()
{
  SurfaceState& s = this->State;
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
  constexpr int rounds = 6;
  for (int round = 0; round < rounds && !intersections.empty(); ++round)
  {
    for (const Proximity::FacePair& pair : intersections)
    {
      KeepAbout(pair.First, faces, old, round, kept);
      KeepAbout(pair.Second, faces, old, round, kept);
    }
    if (round == rounds - 1)
    {
      kept.KeepAll();
    }
    kept.MakeRoom();
    s.Mesh = old;
    volumic::Divide(s.Mesh, &kept, this->Threads);
    intersections = this->FindIntersections();
  }
  if (!intersections.empty())
  {
    // The old surface intersects itself: not seen yet.
    this->TakeRemeshed(old.ToIndexed(this->Threads));
  }
}

void SurfaceEvolution::Implementation::ActivateAll()
{
  SurfaceState& s = this->State;
  ForBlocks(this->Threads, s.Mesh.Rings.size(), VertexBlock,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        if (s.Mesh.IsAlive(static_cast<int>(v)))
        {
          s.Active[v] = 1;
        }
      }
    });
}

void SurfaceEvolution::Implementation::Recover()
{
  this->LastLost = LostParts();
  this->Lost = LostBoundary();
  // Without an isopotential there is no object's side to look for.
  if (!(this->Options.IsopotentialWeight > 0.))
  {
    return;
  }
  const bool recovers = this->Options.RecoverLostParts;
  const double objectShare = recovers && this->Options.RecoverCavities ? 0.5 : 1.;
  const auto find = [this](PartKind kind, double from, double to)
  {
    return FindLostParts(this->State, *this->TheField, kind, this->Options.MinimumPartSize,
      this->Threads, this->CheckpointOf(Monitor::Activity::Recovering, from, to));
  };
  const LostPartCover objects = find(PartKind::Object, 0., objectShare);
  this->Threads.EndPhase("Lost parts");
  this->LastLost.Found = objects.Found;
  this->LastLost.Enclosed = recovers ? objects.Covered : 0;
  this->Lost = objects.Boundary;
  LostPartCover cavities;
  if (recovers && this->Options.RecoverCavities && !this->Stopped)
  {
    cavities = find(PartKind::Cavity, objectShare, 1.);
    this->LastLost.FoundCavities = cavities.Found;
    this->LastLost.EnclosedCavities = cavities.Covered;
    this->Lost.Add(cavities.Boundary);
  }
  if (this->Stopped)
  {
    this->LastLost = LostParts();
    this->Lost = LostBoundary();
    return;
  }
  if (this->LastLost.Enclosed > 0)
  {
    this->State.Mesh.Append(objects.Surface, this->Threads);
  }
  if (this->LastLost.EnclosedCavities > 0)
  {
    this->State.Mesh.Append(cavities.Surface, this->Threads);
  }
}
}

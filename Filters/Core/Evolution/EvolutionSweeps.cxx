// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Levels that are large, block by block: see SweepOptions and SurfaceBlocks. What happens in a block
// is what happens to the whole surface of a small level, but that all else keeps still.

#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Surface/SurfacePolish.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
/** Iterations in a block before the next one is visited: those between two looks at the volume. */
constexpr int SweptIterations = RestCriterion::Interval;
/** Sweeps, and passes in each block, of the regularisation: as many passes as elsewhere. */
constexpr int RegularisingSweeps = 3;
constexpr int SweptPasses = 4;
/** Sweeps between two looks for components that are inside out. */
constexpr int InsideOutSweeps = 2;

void Add(HistoryRow& to, const HistoryRow& row)
{
  to.ActiveVertices += row.ActiveVertices;
  to.TimeStep = std::max(to.TimeStep, row.TimeStep);
  to.Seconds += row.Seconds;
  for (std::size_t i = 0; i < to.Phases.size(); ++i)
  {
    to.Phases[i].Seconds += row.Phases[i].Seconds;
    to.Phases[i].Serial += row.Phases[i].Serial;
  }
}

void Add(HistoryRow& to, const EditCounts& counts)
{
  to.Merges += counts.Merges;
  to.Cuts += counts.Cuts;
  to.Splits += counts.Splits;
  to.Collapses += counts.Collapses;
  to.Flips += counts.Flips;
  to.Deletions += counts.Removed;
  to.DeletedGenus += counts.RemovedGenus;
}
}

void SurfaceEvolution::Implementation::DecideOnSweeps()
{
  if (this->LastIterations > 0)
  {
    return; // Once for a level.
  }
  const std::array<int, 3>& size = this->TheField->Image().Size;
  const std::int64_t voxels = static_cast<std::int64_t>(size[0]) * size[1] * size[2];
  const SweepOptions& sweeps = this->Options.Sweeps;
  this->InSweeps = voxels > sweeps.MostVoxels ||
    this->State.Mesh.NumberOfVertices() > sweeps.MostVertices;
}

float SurfaceEvolution::Implementation::BlockSide() const
{
  return static_cast<float>(this->Options.Sweeps.BlockSide) * this->State.Sizing.Smallest();
}

void SurfaceEvolution::Implementation::VisitBlocks(
  SurfaceBlocks& blocks, const BlockVisits& visits)
{
  const std::vector<int>& order = blocks.Order();
  this->Visit.Blocks = static_cast<int>(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (visits.OnlyActive && !blocks.HasActive(order[i]))
    {
      continue;
    }
    const auto shareOf = [&](std::size_t done)
    {
      const double share = static_cast<double>(done) / static_cast<double>(order.size());
      return visits.From + share * (visits.To - visits.From);
    };
    if (i + 1 < order.size() && HasMemoryLimit())
    {
      blocks.Prefetch(order[i + 1]); // The disk reads while the processors work on this one.
    }
    this->Visit.From = shareOf(i);
    this->Visit.To = shareOf(i + 1);
    visits.Visit(blocks.Open(order[i]));
    blocks.Close();
    this->Visit.Block = static_cast<int>(i + 1);
    this->Visit.Iterations =
      visits.Iterations * static_cast<double>(i + 1) / static_cast<double>(order.size());
    if (!this->GoOn(visits.Doing, this->Visit.To))
    {
      break;
    }
  }
  this->Visit.Block = 0;
  this->Visit.Iterations = 0.;
}

void SurfaceEvolution::Implementation::VisitToEvolve(const std::vector<int>& vertices,
  Dynamics& dynamics, Remesher& remesher, SurfaceBlocks& blocks, std::vector<SweptRow>& rows)
{
  SurfaceState& s = this->State;
  this->Iteration.BeginVisit(vertices);
  for (SweptRow& swept : rows)
  {
    const int before = s.Mesh.NumberOfVertices();
    const int characteristic = s.EulerCharacteristic;
    HistoryRow row;
    this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Evolve);
    blocks.AddNew(this->Iteration.WorkingVertices());
    Add(swept.Row, row);
    Add(swept.Row, s.Counts);
    swept.Row.KineticEnergy += this->KineticEnergy(); // Of all: divided in KeepSweptRows.
    swept.Vertices += s.Mesh.NumberOfVertices() - before;
    swept.EulerCharacteristic += s.EulerCharacteristic - characteristic;
    if (this->Stopped)
    {
      break;
    }
  }
  this->Iteration.EndVisit();
}

void SurfaceEvolution::Implementation::RunSweep(
  Dynamics& dynamics, Remesher& remesher, SurfaceBlocks& blocks)
{
  SurfaceState& s = this->State;
  const int iterations =
    std::min(SweptIterations, this->Options.MaximumNumberOfIterations - this->LastIterations);
  std::vector<SweptRow> rows(static_cast<std::size_t>(iterations));
  this->BeginRow(rows.front().Row);
  const int vertices = s.Mesh.NumberOfVertices();
  const int characteristic = s.EulerCharacteristic;
  ++this->Visit.Sweep;
  BlockVisits visits;
  visits.Iterations = iterations;
  visits.Visit = [&](const std::vector<int>& ofBlock)
  { this->VisitToEvolve(ofBlock, dynamics, remesher, blocks, rows); };
  this->VisitBlocks(blocks, visits);

  s.Counts = EditCounts();
  const int before = s.Mesh.NumberOfVertices();
  const int characteristicBefore = s.EulerCharacteristic;
  this->Iteration.LabelComponents();
  if (this->Visit.Sweep % InsideOutSweeps == 0 && this->Iteration.IsUnchecked())
  {
    this->Iteration.DeleteInsideOut();
  }
  Add(rows.back().Row, s.Counts);
  rows.back().Vertices += s.Mesh.NumberOfVertices() - before;
  rows.back().EulerCharacteristic += s.EulerCharacteristic - characteristicBefore;
  this->Threads.EndPhase("Components");
  this->KeepSweptRows(rows, vertices, characteristic);
}

void SurfaceEvolution::Implementation::KeepSweptRows(
  std::vector<SweptRow>& rows, int vertices, int eulerCharacteristic)
{
  // As if all blocks had been in the same iteration: what has changed in each, added up.
  const double meanEdge = this->MeanEdgeLength();
  double seconds = this->Lap();
  for (SweptRow& swept : rows)
  {
    HistoryRow& row = swept.Row;
    vertices += swept.Vertices;
    eulerCharacteristic += swept.EulerCharacteristic;
    row.Iteration = static_cast<int>(this->Rows.size()) + 1;
    row.Level = this->Level;
    row.Vertices = row.IterationVertices = vertices;
    row.EulerCharacteristic = row.IterationEulerCharacteristic = eulerCharacteristic;
    row.Components = row.IterationComponents = this->Iteration.NumberOfComponents();
    row.MeanEdgeLength = row.IterationMeanEdgeLength = meanEdge;
    row.KineticEnergy /= std::max(vertices, 1);
    // The visits' own times, and what lies between them with the last.
    row.Seconds = &swept == &rows.back() ? seconds : std::min(row.Seconds, seconds);
    seconds -= row.Seconds;
    this->KeepRow(row);
  }
}

void SurfaceEvolution::Implementation::RegulariseInSweeps(
  Dynamics& dynamics, Remesher& remesher, SurfaceBlocks& blocks)
{
  SurfaceState& s = this->State;
  for (int sweep = 0; sweep < RegularisingSweeps && !this->Stopped; ++sweep)
  {
    BlockVisits visits;
    visits.Doing = Monitor::Activity::Regularising;
    visits.From = PassesShare * sweep / RegularisingSweeps;
    visits.To = PassesShare * (sweep + 1) / RegularisingSweeps;
    visits.Visit = [&](const std::vector<int>& vertices)
    {
      this->Iteration.BeginVisit(vertices);
      for (int pass = 0; pass < SweptPasses; ++pass)
      {
        for (const int v : vertices)
        {
          s.Disturbed[v] = 0;
        }
        HistoryRow row;
        this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Regularise);
        blocks.AddNew(this->Iteration.WorkingVertices());
        this->KeepActiveIfMoving(); // Also beyond the block, for the visits to come.
      }
      for (const int v : vertices)
      {
        s.Velocity[v] = Vector();
      }
      this->Iteration.EndVisit();
    };
    this->VisitBlocks(blocks, visits);
  }
}

void SurfaceEvolution::Implementation::PolishInSweeps(SurfaceBlocks& blocks)
{
  SurfaceState& s = this->State;
  bool hasCut = false;
  BlockVisits visits;
  visits.OnlyActive = false;
  visits.Doing = Monitor::Activity::Regularising;
  visits.From = PassesShare;
  visits.Visit = [&](const std::vector<int>& vertices)
  {
    blocks.AddNew(this->Polish(
      this->CheckpointOf(visits.Doing, this->Visit.From, this->Visit.To), &vertices));
    hasCut = hasCut || s.Counts.Cuts > 0;
  };
  if (!this->Stopped)
  {
    this->VisitBlocks(blocks, visits);
  }
  s.Counts = EditCounts();
  this->Iteration.LabelComponents();
  if (hasCut)
  {
    this->Iteration.DeleteDegenerate();
  }
  this->SinceEvolved.Removed += s.Counts.Removed;
}
}

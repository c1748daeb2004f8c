// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Levels that are large, block by block: see SweepOptions and SurfaceBlocks. What happens in a block
// is what happens to the whole surface of a small level, but that all else keeps still.

#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfacePolish.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>

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
  this->InSweeps = AreInSweeps(this->Options, this->TheField->Image().Size) ||
    this->State.Mesh.NumberOfVertices() > this->Options.Sweeps.MostVertices;
}

SurfaceBlocks::Frame SurfaceEvolution::Implementation::FrameOfLevel() const
{
  const LevelImage& image = this->TheField->Image();
  std::array<double, 3> extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[axis] = image.Size[axis] * image.Step[axis];
  }
  return SurfaceBlocks::FrameOf(
    extent, this->Options.Sweeps.BlockSide * this->State.Sizing.Smallest());
}

void SurfaceEvolution::Implementation::BeginSweeps()
{
  SurfaceState& s = this->State;
  if (this->Blocks)
  {
    return; // It has come here in blocks.
  }
  if (this->AreRanks())
  {
    s.Sizing = BroadcastValue(*this->Ranks, s.Sizing);
  }
  if (!this->AreRanks())
  {
    this->Blocks = std::make_unique<SurfaceBlocks>(s, this->FrameOfLevel(), this->Threads);
    return;
  }
  this->Iteration.Forget();
  this->ShareBlocks(s.Mesh);
  this->AgreeOnGridBox();
  this->OnRanks->Scatter(this->GridLow, this->GridHigh);
}

void SurfaceEvolution::Implementation::EndSweeps()
{
  if (!this->OnRanks) // Else the surface stays in parts until it is wanted as a whole.
  {
    this->Blocks.reset();
  }
}

void SurfaceEvolution::Implementation::AddPlaces()
{
  if (this->OnRanks)
  {
    this->OnRanks->AddPlaces();
    return;
  }
  std::vector<int> counts;
  for (int block = 0; block < this->Blocks->NumberOfBlocks(); ++block)
  {
    counts.push_back(this->Blocks->MissingPlaces(block));
  }
  this->Blocks->AddPlaces(counts);
}

bool SurfaceEvolution::Implementation::VisitBlock(
  int block, std::size_t visited, const BlockVisits& visits)
{
  const auto count = static_cast<double>(this->Blocks->NumberOfBlocks());
  const auto shareOf = [&](std::size_t done)
  {
    const double share = static_cast<double>(done) / count;
    return visits.From + share * (visits.To - visits.From);
  };
  this->Visit.From = shareOf(visited);
  this->Visit.To = shareOf(visited + 1);
  this->Visiting = block;
  visits.Visit(this->Blocks->Open(block));
  this->Blocks->Close();
  this->Visit.Block = static_cast<int>(visited + 1);
  this->Visit.Iterations = visits.Iterations * static_cast<double>(visited + 1) / count;
  return this->GoOn(visits.Doing, this->Visit.To);
}

void SurfaceEvolution::Implementation::VisitBlocks(const BlockVisits& visits)
{
  this->AddPlaces();
  this->Visit.Blocks = this->Blocks->NumberOfBlocks();
  if (this->OnRanks)
  {
    this->VisitBlocksOnRanks(visits);
  }
  else
  {
    const std::vector<int>& order = this->Blocks->Order();
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      if (visits.OnlyActive && !this->Blocks->HasActive(order[i]))
      {
        continue;
      }
      if (i + 1 < order.size() && HasMemoryLimit())
      {
        // The disk reads while the processors work on this one.
        this->Blocks->Prefetch(order[i + 1]);
      }
      if (!this->VisitBlock(order[i], i, visits))
      {
        break;
      }
    }
  }
  this->Visit.Block = 0;
  this->Visit.Iterations = 0.;
}

Box SurfaceEvolution::Implementation::AboutBlock() const
{
  return this->Blocks->BoxOf(this->Visiting)
    .Grown(SurfaceBlocks::WrittenInDelta * this->State.Sizing.Largest());
}

void SurfaceEvolution::Implementation::VisitToEvolve(const std::vector<int>& vertices,
  Dynamics& dynamics, Remesher& remesher, std::vector<SweptRow>& rows)
{
  SurfaceState& s = this->State;
  this->Iteration.BeginVisit(vertices, this->AboutBlock());
  for (SweptRow& swept : rows)
  {
    const int before = s.Mesh.NumberOfVertices();
    const int characteristic = s.EulerCharacteristic;
    HistoryRow row;
    this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Evolve);
    this->Blocks->AddNew(this->Iteration.WorkingVertices());
    Add(swept.Row, row);
    Add(swept.Row, s.Counts);
    swept.KineticEnergy[static_cast<std::size_t>(this->Visiting)] = this->KineticEnergy();
    swept.Vertices += s.Mesh.NumberOfVertices() - before;
    swept.EulerCharacteristic += s.EulerCharacteristic - characteristic;
    if (this->Stopped)
    {
      break;
    }
  }
  this->Iteration.EndVisit();
}

double SurfaceEvolution::Implementation::SumOfBlocksOf(
  const std::function<double(int v)>& ofVertex)
{
  const auto isOwn = [this](int block) { return !this->OnRanks || this->OnRanks->IsOwn(block); };
  const std::vector<double> sums = this->Blocks->Sums(isOwn, ofVertex, this->Threads);
  return this->OnRanks ? this->OnRanks->AddUp(sums) : std::accumulate(sums.begin(), sums.end(), 0.);
}

double SurfaceEvolution::Implementation::Area()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  return this->SumOfBlocksOf([&mesh](int v) { return AreaShare(mesh, v); });
}

double SurfaceEvolution::Implementation::Volume()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  if (!this->Blocks)
  {
    return EnclosedVolume(mesh, this->Threads);
  }
  const Vector origin = this->Blocks->GetFrame().Low;
  return this->SumOfBlocksOf(
    [&mesh, origin](int v)
    {
      SignedVolume share(origin);
      share.Add(mesh, v);
      return share.Value();
    });
}

void SurfaceEvolution::Implementation::RunSweep(Dynamics& dynamics, Remesher& remesher)
{
  SurfaceState& s = this->State;
  const int iterations =
    std::min(SweptIterations, this->Options.MaximumNumberOfIterations - this->LastIterations);
  std::vector<SweptRow> rows(static_cast<std::size_t>(iterations));
  for (SweptRow& row : rows)
  {
    row.KineticEnergy.assign(static_cast<std::size_t>(this->Blocks->NumberOfBlocks()), 0.);
  }
  this->BeginRow(rows.front().Row);
  const int vertices = s.Mesh.NumberOfVertices();
  const int characteristic = s.EulerCharacteristic;
  ++this->Visit.Sweep;
  BlockVisits visits;
  visits.Iterations = iterations;
  visits.Visit = [&](const std::vector<int>& ofBlock)
  { this->VisitToEvolve(ofBlock, dynamics, remesher, rows); };
  this->VisitBlocks(visits);
  this->AddUpRows(rows);

  s.Counts = EditCounts();
  const int before = s.Mesh.NumberOfVertices();
  const int characteristicBefore = s.EulerCharacteristic;
  this->LabelComponents();
  if (this->Visit.Sweep % InsideOutSweeps == 0 &&
    this->IsOnAnyRank(this->Iteration.IsUnchecked()))
  {
    this->DeleteThoseInsideOut();
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
    row.KineticEnergy =
      std::accumulate(swept.KineticEnergy.begin(), swept.KineticEnergy.end(), 0.) /
      std::max(vertices, 1);
    // The visits' own times, and what lies between them with the last.
    row.Seconds = &swept == &rows.back() ? seconds : std::min(row.Seconds, seconds);
    seconds -= row.Seconds;
    this->KeepRow(row);
  }
}

void SurfaceEvolution::Implementation::RegulariseInSweeps(Dynamics& dynamics, Remesher& remesher)
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
      this->Iteration.BeginVisit(vertices, this->AboutBlock());
      for (int pass = 0; pass < SweptPasses; ++pass)
      {
        for (const int v : vertices)
        {
          s.Disturbed[v] = 0;
        }
        HistoryRow row;
        this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Regularise);
        this->Blocks->AddNew(this->Iteration.WorkingVertices());
        this->KeepActiveIfMoving(); // Also beyond the block, for the visits to come.
      }
      for (const int v : vertices)
      {
        s.Velocity[v] = Vector();
      }
      this->Iteration.EndVisit();
    };
    this->VisitBlocks(visits);
  }
}

void SurfaceEvolution::Implementation::PolishInSweeps()
{
  SurfaceState& s = this->State;
  bool hasCut = false;
  BlockVisits visits;
  visits.OnlyActive = false;
  visits.Doing = Monitor::Activity::Regularising;
  visits.From = PassesShare;
  visits.Visit = [&](const std::vector<int>& vertices)
  {
    this->Blocks->AddNew(this->Polish(
      this->CheckpointOf(visits.Doing, this->Visit.From, this->Visit.To), &vertices));
    hasCut = hasCut || s.Counts.Cuts > 0;
  };
  if (!this->Stopped)
  {
    this->VisitBlocks(visits);
  }
  s.Counts = EditCounts();
  this->LabelComponents();
  if (this->IsOnAnyRank(hasCut))
  {
    this->DeleteDegenerate();
    this->SinceEvolved.Removed += this->IsFirstRank() ? s.Counts.Removed : 0;
  }
}
}

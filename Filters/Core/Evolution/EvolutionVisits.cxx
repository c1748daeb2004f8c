// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How a surface is worked on: in visits of blocks, see SurfaceBlocks, and in sums over blocks.

#include "Core/Common/Spans.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Mesh/SurfaceMeasures.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** Iterations in a block before the next one is visited: those between two looks at the volume. */
constexpr int SweptIterations = RestCriterion::Interval;
/** Sweeps between two looks for components that are inside out. */
constexpr int InsideOutSweeps = 2;

void Add(HistoryRow& to, const HistoryRow& row)
{
  to.ActiveVertices += row.ActiveVertices;
  to.TimeStep = std::max(to.TimeStep, row.TimeStep);
  for (std::size_t i = 0; i < to.PhaseSeconds.size(); ++i)
  {
    to.PhaseSeconds[i] += row.PhaseSeconds[i];
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

SurfaceBlocks::Frame SurfaceEvolution::Implementation::FrameOfLevel() const
{
  const LevelImage& image = this->TheField->Image();
  std::array<double, 3> extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[axis] = image.Size[axis] * image.Step[axis];
  }
  const double side =
    this->Options.BlockSide > 0. ? this->Options.BlockSide : SurfaceBlocks::SideInDelta;
  return SurfaceBlocks::FrameOf(extent, side * this->State.Sizing.Largest());
}

void SurfaceEvolution::Implementation::MakeBlocks()
{
  this->ForgetBlocks();
  this->Blocks =
    std::make_unique<SurfaceBlocks>(this->State, this->FrameOfLevel(), this->Threads);
  this->Components = std::make_unique<SurfaceComponents>();
}

void SurfaceEvolution::Implementation::ForgetBlocks()
{
  this->Components.reset();
  this->Blocks.reset();
}

SurfaceIteration& SurfaceEvolution::Implementation::TakeIteration()
{
  const std::lock_guard<std::mutex> lock(this->Handing);
  if (this->Idle.empty())
  {
    this->Iterations.push_back(std::make_unique<SurfaceIteration>(this->State));
    this->Idle.push_back(this->Iterations.back().get());
  }
  SurfaceIteration* iteration = this->Idle.back();
  this->Idle.pop_back();
  return *iteration;
}

void SurfaceEvolution::Implementation::VisitBlock(
  int block, const BlockVisits& visits, Executor& idle)
{
  if (visits.OnlyActive && !this->Blocks->HasActive(block))
  {
    return;
  }
  this->Blocks->Prefetch(block);
  SurfaceIteration& iteration = this->TakeIteration();
  BlockVisit visit = this->Blocks->Open(block);
  visit.Idle = &idle;
  visits.Visit(visit, iteration);
  const EditCounts counts = visit.Share.Counts;
  this->Blocks->Close(std::move(visit));
  const std::lock_guard<std::mutex> lock(this->Handing);
  this->State.Counts += counts;
  this->Unchecked += counts.Cuts + counts.Removed;
  this->Idle.push_back(&iteration);
}

void SurfaceEvolution::Implementation::VisitBlocks(const BlockVisits& visits)
{
  this->State.Counts = EditCounts();
  this->Blocks->Prepare(this->Threads);
  const auto count = static_cast<std::size_t>(this->Blocks->NumberOfBlocks());
  this->Visit.Blocks = static_cast<int>(count);
  const auto goOn = [&](std::size_t done)
  {
    const double share = static_cast<double>(done) / static_cast<double>(count);
    this->Visit.Block = static_cast<int>(done);
    this->Visit.Iterations = visits.Iterations * share;
    return !visits.IsAsked ||
      this->GoOn(visits.Doing, visits.From + share * (visits.To - visits.From));
  };
  this->Blocks->Schedule().Run(
    this->Threads,
    [&](int block, std::size_t, Executor& idle) { this->VisitBlock(block, visits, idle); }, goOn);
  this->Visit.Block = 0;
  this->Visit.Iterations = 0.;
}

double SurfaceEvolution::Implementation::KineticEnergy(const SurfaceIteration& iteration) const
{
  const SurfaceState& s = this->State;
  double sum = 0;
  for (const int v : iteration.ActiveVertices())
  {
    const double speed = s.Mesh.IsAlive(v) ? Dot(s.Velocity[v], s.Normal[v].Axis()) : 0.;
    sum += 0.5 * speed * speed;
  }
  return sum;
}

void SurfaceEvolution::Implementation::VisitToEvolve(BlockVisit& visit,
  SurfaceIteration& iteration, const Dynamics& dynamics, std::vector<SweptRow>& rows)
{
  const Field* evidence = this->Options.IsopotentialWeight > 0 ? this->TheField.get() : nullptr;
  Remesher remesher(this->State, evidence, this->Options.TopologyChanges, &visit.Share);
  iteration.BeginVisit(visit);
  std::vector<SweptRow> own(rows.size());
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    const int added = visit.Share.Room.Added;
    const int characteristic = visit.Share.EulerCharacteristic;
    const EditCounts counts = visit.Share.Counts;
    iteration.Run(own[i].Row, dynamics, remesher, SurfaceIteration::Mode::Evolve);
    rows[i].KineticEnergy[static_cast<std::size_t>(visit.Block)] = this->KineticEnergy(iteration);
    own[i].Counts = visit.Share.Counts - counts;
    own[i].Vertices = visit.Share.Room.Added - added;
    own[i].EulerCharacteristic = visit.Share.EulerCharacteristic - characteristic;
  }
  iteration.EndVisit();
  const std::lock_guard<std::mutex> lock(this->Handing);
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    Add(rows[i].Row, own[i].Row);
    Add(rows[i].Row, own[i].Counts);
    rows[i].Vertices += own[i].Vertices;
    rows[i].EulerCharacteristic += own[i].EulerCharacteristic;
  }
}

double SurfaceEvolution::Implementation::Area() const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  return this->Blocks->SumUp([&mesh](int v) { return AreaShare(mesh, v); }, this->Threads);
}

double SurfaceEvolution::Implementation::Volume() const
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const Vector origin = this->Blocks->GetFrame().Low;
  return this->Blocks->SumUp(
    [&mesh, origin](int v)
    {
      SignedVolume share(origin);
      share.Add(mesh, v);
      return share.Value();
    },
    this->Threads);
}

void SurfaceEvolution::Implementation::RunSweep(const Dynamics& dynamics)
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
  visits.Visit = [&](BlockVisit& visit, SurfaceIteration& iteration)
  { this->VisitToEvolve(visit, iteration, dynamics, rows); };
  this->VisitBlocks(visits);

  const bool hasChanged = this->Visit.Sweep == 1 ||
    std::any_of(rows.begin(), rows.end(), [](const SweptRow& swept)
      { return swept.Row.Merges + swept.Row.Cuts + swept.Row.Deletions > 0; });
  s.Counts = EditCounts();
  const int before = s.Mesh.NumberOfVertices();
  const int characteristicBefore = s.EulerCharacteristic;
  if (this->Visit.Sweep % InsideOutSweeps == 0 && this->Unchecked > 0)
  {
    this->DeleteThoseInsideOut(); // Labels them, too.
  }
  else if (hasChanged)
  {
    this->LabelComponents();
  }
  Add(rows.back().Row, s.Counts);
  rows.back().Vertices += s.Mesh.NumberOfVertices() - before;
  rows.back().EulerCharacteristic += s.EulerCharacteristic - characteristicBefore;
  this->KeepSweptRows(rows, vertices, characteristic);
}

void SurfaceEvolution::Implementation::KeepSweptRows(
  std::vector<SweptRow>& rows, int vertices, int eulerCharacteristic)
{
  // As if all blocks had been in the same iteration: what has changed in each, added up. The
  // seconds are shared out as the threads that make the visits have spent them.
  const double meanEdge = this->MeanEdgeLength();
  this->Visit.Volume = this->Volume();
  const double seconds = this->Lap();
  double spent = 0.;
  this->Visit.Active = rows.back().Row.ActiveVertices;
  for (const SweptRow& swept : rows)
  {
    for (const double ofPhase : swept.Row.PhaseSeconds)
    {
      spent += ofPhase;
    }
  }
  const double equal = seconds / static_cast<double>(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    HistoryRow& row = rows[i].Row;
    vertices += rows[i].Vertices;
    eulerCharacteristic += rows[i].EulerCharacteristic;
    row.Iteration = static_cast<int>(this->Rows.size()) + 1;
    row.Level = this->Level;
    row.Vertices = row.IterationVertices = vertices;
    row.EulerCharacteristic = row.IterationEulerCharacteristic = eulerCharacteristic;
    row.Components = row.IterationComponents = this->NumberOfComponents;
    row.MeanEdgeLength = row.IterationMeanEdgeLength = meanEdge;
    const std::vector<double>& energy = rows[i].KineticEnergy;
    row.KineticEnergy =
      std::accumulate(energy.begin(), energy.end(), 0.) / std::max(vertices, 1);
    row.Seconds = spent > 0. ? 0. : equal;
    for (double& ofPhase : row.PhaseSeconds)
    {
      ofPhase *= spent > 0. ? seconds / spent : 0.;
      row.Seconds += ofPhase;
    }
    this->KeepRow(row);
  }
}

void SurfaceEvolution::Implementation::VisitAll(SurfaceIteration::Mode mode,
  const Dynamics& dynamics, int iterations, Monitor::Activity doing, double from, double to)
{
  BlockVisits visits;
  visits.OnlyActive = true;
  visits.Doing = doing;
  visits.From = from;
  visits.To = to;
  visits.Visit = [&](BlockVisit& visit, SurfaceIteration& iteration)
  {
    SurfaceState& s = this->State;
    Remesher remesher(s, this->TheField.get(), false, &visit.Share);
    iteration.BeginVisit(visit);
    for (int i = 0; i < iterations; ++i)
    {
      for (int v = visit.First; v < visit.End(); ++v)
      {
        s.Disturbed[v] = 0;
      }
      HistoryRow row;
      iteration.Run(row, dynamics, remesher, mode);
      if (mode != SurfaceIteration::Mode::Adapt)
      {
        this->KeepActiveIfMoving(iteration); // Also beyond the block, for the visits to come.
      }
    }
    for (int v = visit.First; v < visit.End(); ++v)
    {
      s.Velocity[v] = Vector();
    }
    iteration.EndVisit();
  };
  this->VisitBlocks(visits);
  this->SinceEvolved.Cuts += this->State.Counts.Cuts;
  this->SinceEvolved.Removed += this->State.Counts.Removed;
}

void SurfaceEvolution::Implementation::SplitLongEdges()
{
  BlockVisits visits;
  visits.IsAsked = false;
  this->SplitLongEdges(std::move(visits));
}

void SurfaceEvolution::Implementation::SplitLongEdges(BlockVisits visits)
{
  // Verification relies on it that no edge is longer than the constraints allow. One whose split
  // would make needles stays, as in an iteration, and what moves it waits: see HasHugeEdge.
  visits.OnlyActive = false;
  visits.Visit = [this](BlockVisit& visit, SurfaceIteration&)
  {
    Remesher remesher(this->State, nullptr, false, &visit.Share);
    std::vector<int> vertices(static_cast<std::size_t>(visit.End() - visit.First));
    std::iota(vertices.begin(), vertices.end(), visit.First);
    remesher.Split(vertices);
    SurfaceIteration::UpdateChanged(this->State, remesher.TakeChanged());
  };
  // A block may have too little room for all of them at once, and half of a split edge is split again.
  do
  {
    this->VisitBlocks(visits);
  } while (!(visits.IsAsked && this->Stopped) &&
    this->State.Counts.Splits > 0 && this->HasEdgeTooLong());
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/Stopwatch.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfacePolish.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
/** Passes of tangential smoothing and snapping at the end of a level. */
constexpr int RegularisationPasses = 12;
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexGrain = 2048;
/** Way in a pass, in delta, under which a vertex is left where it is. */
constexpr float SmallestMove = 0.015f;
/** Iterations after which the estimate of a level's progress is 1 - 1/e of its way. */
constexpr double TypicalIterations = 80.;
/** Share of a level's progress that is left to what comes before and after its iterations. */
constexpr double ShareBefore = 0.1;
constexpr double ShareAfter = 0.2;
/** Of a regularisation, the passes; the rest is the polish. */
constexpr double PassesShare = 0.6;

/** Of a level, in [0, 1]. */
double FractionOf(Monitor::Activity doing, double share, int iterations)
{
  switch (doing)
  {
    case Monitor::Activity::Starting:
      return ShareBefore * share;
    case Monitor::Activity::Dividing:
      return 0.5 * ShareBefore * share;
    case Monitor::Activity::Recovering:
      return 0.5 * ShareBefore * (1. + share);
    case Monitor::Activity::Iterating:
      return ShareBefore +
        (1. - ShareBefore - ShareAfter) * (1. - std::exp(-iterations / TypicalIterations));
    default:
      return 1. - ShareAfter * (1. - share);
  }
}
}

bool SurfaceEvolution::Implementation::GoOn(Monitor::Activity doing, double share)
{
  return this->Ask(&Monitor::GoOn, doing, share);
}

bool SurfaceEvolution::Implementation::Ask(
  bool (Monitor::*question)(const Monitor::Status&), Monitor::Activity doing, double share)
{
  if (this->Stopped)
  {
    return false;
  }
  Monitor::Status status;
  status.Level = this->Level;
  status.Doing = doing;
  status.Iteration = this->LastIterations;
  status.Vertices = this->State.Mesh.NumberOfVertices();
  status.ActiveVertices = static_cast<int>(this->Iteration.ActiveVertices().size());
  status.Fraction = FractionOf(doing, std::clamp(share, 0., 1.), this->LastIterations);
  this->Stopped = !(this->Listener.*question)(status);
  return !this->Stopped;
}

Checkpoint SurfaceEvolution::Implementation::CheckpointOf(
  Monitor::Activity doing, double from, double to)
{
  return [this, doing, from, to](double share)
  { return this->GoOn(doing, from + (to - from) * share); };
}

void SurfaceEvolution::Implementation::Iterate(
  HistoryRow& row, Dynamics& dynamics, Remesher& remesher, SurfaceIteration::Mode mode)
{
  const auto start = std::chrono::steady_clock::now();
  const bool evolves = mode == SurfaceIteration::Mode::Evolve;
  const auto goOn = [this, evolves]
  { return !evolves || this->GoOn(Monitor::Activity::Iterating, 1.); };
  this->Iteration.Run(row, dynamics, remesher, mode, this->LastIterations, goOn);
  this->FillRow(row);
  this->Threads.EndPhase("History");
  this->SinceEvolved.Cuts += this->State.Counts.Cuts;
  this->SinceEvolved.Removed += this->State.Counts.Removed;
  row.Seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

StopReason SurfaceEvolution::Implementation::Evolve()
{
  SurfaceState& s = this->State;
  this->LastIterations = 0;
  this->Rest.Reset();
  this->Cycle.Reset();
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  const bool evidence = this->Options.IsopotentialWeight > 0;
  Remesher remesher(s, evidence ? this->TheField.get() : nullptr, this->Options.TopologyChanges,
    this->Threads);
  const double cube = std::pow(static_cast<double>(s.Sizing.OfLevel()), 3);
  while (true)
  {
    this->Threads.EndPhase("Rest criterion");
    if (this->Stopped)
    {
      return StopReason::Cancelled;
    }
    if (s.Mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
    if (this->LastIterations >= this->Options.MaximumNumberOfIterations)
    {
      return StopReason::IterationLimit;
    }
    HistoryRow row;
    row.SecondsBefore = this->Lap();
    row.AddedEulerCharacteristic = s.EulerCharacteristic -
      (this->Rows.empty() ? 0 : this->Rows.back().EulerCharacteristic);
    this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Evolve);
    row.Seconds = this->Lap();
    if (this->LastIterations == 0)
    {
      row.Recovered = this->LastLost.Enclosed + this->LastLost.EnclosedCavities;
      for (const Phase phase : { Phase::Division, Phase::Recovery })
      {
        row.Phases[static_cast<int>(phase)] = this->Preparing.Phases[static_cast<int>(phase)];
      }
      this->Preparing = HistoryRow();
    }
    this->Rows.push_back(row);
    this->SinceEvolved = EditCounts();
    ++this->LastIterations;
    if (!this->Ask(&Monitor::Continue, Monitor::Activity::Iterating, 1.))
    {
      return StopReason::Cancelled;
    }
    if (this->LastIterations % RestCriterion::Interval == 0 && s.Mesh.NumberOfVertices() > 0)
    {
      const double volume = EnclosedVolume(s.Mesh, this->Threads);
      const double limit =
        std::max(cube, this->Options.ConvergenceTolerance * std::abs(volume));
      this->Rest.Add(volume);
      this->Cycle.Add(volume);
      if (this->Rest.IsMet(limit))
      {
        return StopReason::Converged;
      }
      if (this->Cycle.IsMet(limit))
      {
        return StopReason::LimitCycle;
      }
    }
  }
}

void SurfaceEvolution::Implementation::KeepActiveIfMoving()
{
  // What went some way in the last pass stays active, with its neighbours, and what was edited.
  SurfaceState& s = this->State;
  const std::vector<int>& last = this->Iteration.ActiveVertices();
  std::vector<std::uint8_t> moves(static_cast<std::size_t>(s.Mesh.Size()), 0);
  this->Threads.For(last.size(), VertexGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = last[i];
        if (s.Mesh.IsAlive(v))
        {
          const float least = SmallestMove * s.Sizing.At(v);
          moves[v] = SquaredLength(s.Velocity[v]) > least * least;
          s.Active[v] = s.Active[v] && (s.Disturbed[v] || moves[v]);
        }
      }
    });
  this->Threads.For(moves.size(), VertexGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (s.Mesh.IsAlive(v) && !s.Active[v])
        {
          const Ring& ring = s.Mesh.Rings[v];
          s.Active[v] = std::any_of(
            ring.Item, ring.Item + ring.Count, [&moves](int neighbour) { return moves[neighbour]; });
        }
      }
    });
}

void SurfaceEvolution::Implementation::FitMeanEdge(Dynamics& dynamics)
{
  // Edges anywhere in [delta, 2.5 delta] are left as they are, so their mean depends on where they
  // come from. With delta changing slowly the worst of them are collapsed or split first.
  constexpr int steps = 30;
  constexpr double close = 0.02;
  constexpr double share = 0.6; // of what is missing, in a step
  constexpr double longestStep = 0.03;
  SurfaceState& s = this->State;
  const double unit = this->TheField->Image().Unit;
  const float least = static_cast<float>(SizingField::LeastSamplingRatio * unit);
  const float most = static_cast<float>(unit);
  Remesher remesher(s, this->TheField.get(), false, this->Threads);
  double first = 0.;
  for (int step = 0; step < steps && s.Mesh.NumberOfVertices() > 0 &&
       this->GoOn(Monitor::Activity::Regularising, 0.);
       ++step)
  {
    const double missing = this->WantedMeanEdge / this->MeanEdgeLength() - 1.;
    first = step == 0 ? missing : first;
    const double change = std::min(std::max(share * missing, -longestStep), longestStep);
    const float old = s.Sizing.OfLevel();
    const float delta = std::min(std::max(old * static_cast<float>(1. + change), least), most);
    if (std::abs(missing) < close || missing * first < 0. || delta == old)
    {
      break;
    }
    s.Sizing = SizingField(delta);
    this->Reset();
    s.Velocity.Fill(Vector());
    HistoryRow row;
    this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Regularise);
  }
}

void SurfaceEvolution::Implementation::Regularise(Dynamics& dynamics)
{
  // The same verified displacements and edits, driven by shape and residual instead of forces.
  SurfaceState& s = this->State;
  const std::vector<std::uint8_t> active = s.Active.AsVector();
  Remesher remesher(s, this->TheField.get(), false, this->Threads);
  s.Velocity.Fill(Vector());
  HistoryRow row;
  this->ActivateAll();
  for (int pass = 0; pass < RegularisationPasses && s.Mesh.NumberOfVertices() > 0 &&
       this->GoOn(Monitor::Activity::Regularising, PassesShare * pass / RegularisationPasses);
       ++pass)
  {
    if (pass > 0)
    {
      this->KeepActiveIfMoving();
    }
    s.Disturbed.Fill(0);
    this->Threads.EndPhase("Regularisation");
    this->Iterate(row, dynamics, remesher, SurfaceIteration::Mode::Regularise);
  }
  this->RunPolish(row);
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    s.Active[v] = s.Mesh.IsAlive(v) && (v >= static_cast<int>(active.size()) || active[v]);
    s.Velocity[v] = Vector();
  }
}

void SurfaceEvolution::Implementation::RunPolish(HistoryRow& row)
{
  SurfaceState& s = this->State;
  const auto start = std::chrono::steady_clock::now();
  s.Counts = EditCounts();
  SurfacePolish polish(s, this->Options.SnapToIsoValue ? this->TheField.get() : nullptr,
    this->Options.TopologyChanges, this->Threads,
    this->CheckpointOf(Monitor::Activity::Regularising, PassesShare));
  polish.Run();
  this->Iteration.UpdateChanged(polish.TakeChanged());
  this->Threads.EndPhase("Polish");
  if (s.Counts.Cuts > 0)
  {
    this->Iteration.LabelComponents();
    this->Iteration.DeleteDegenerate();
  }
  this->SinceEvolved.Cuts += s.Counts.Cuts;
  this->SinceEvolved.Removed += s.Counts.Removed;
  row.Seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void SurfaceEvolution::Implementation::DeleteInsideOut()
{
  this->State.Counts = EditCounts();
  this->Iteration.DeleteInsideOut();
  this->SinceEvolved.Removed += this->State.Counts.Removed;
}

void SurfaceEvolution::Implementation::FindMissing()
{
  const LostBoundary::Missing missing =
    this->Lost.MissedBy(this->State, *this->TheField, this->Threads);
  this->LastLost.Missing = missing.Parts;
  this->LastLost.MissingBoundary = missing.Share;
}

StopReason SurfaceEvolution::Implementation::Run()
{
  const StopReason reason = this->Evolve();
  this->DeleteInsideOut();
  if (reason == StopReason::Cancelled || reason == StopReason::Vanished)
  {
    this->FinishRow();
    this->FindMissing();
    return reason;
  }
  HistoryRow none;
  Stopwatch watch(this->HasIteration() ? this->Rows.back() : none, this->Threads);
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  if (this->WantedMeanEdge > 0.)
  {
    this->FitMeanEdge(dynamics);
  }
  this->Regularise(dynamics);
  this->DeleteInsideOut(); // The polish may have cut.
  this->FinishRow();
  watch.Lap(Phase::Regularisation);
  this->FindMissing();
  watch.Lap(Phase::Recovery);
  if (this->Stopped)
  {
    return StopReason::Cancelled;
  }
  return this->State.Mesh.NumberOfVertices() > 0 ? reason : StopReason::Vanished;
}
}

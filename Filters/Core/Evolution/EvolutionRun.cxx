// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Spans.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/Stopwatch.h"
#include "Core/Surface/SurfacePolish.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** Sweeps of the regularisation, and passes in each block. */
constexpr int RegularisingSweeps = 3;
constexpr int SweptPasses = 4;
/** Way in a pass, in delta, under which a vertex is left where it is. */
constexpr float SmallestMove = 0.015f;
/** Vertices that one thread looks at at a time. */
constexpr std::size_t VertexGrain = 2048;
/** Iterations after which the estimate of a level's progress is 1 - 1/e of its way. */
constexpr double TypicalIterations = 80.;
/** Share of a level's progress that is left to what comes before and after its iterations. */
constexpr double ShareBefore = 0.1;
constexpr double ShareAfter = 0.2;

/** Of a level, in [0, 1]. */
double FractionOf(Monitor::Activity doing, double share, double iterations)
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
  if (this->IsMending)
  {
    return true;
  }
  if (this->Stopped)
  {
    return false;
  }
  Monitor::Status status;
  status.Level = this->Level;
  status.Doing = doing;
  status.Iteration = this->LastIterations;
  status.Vertices =
    this->Blocks ? this->Blocks->NumberOfVertices() : this->State.Mesh.NumberOfVertices();
  status.ActiveVertices = this->Visit.Active;
  status.Sweep = this->Visit.Sweep;
  status.Block = this->Visit.Block;
  status.Blocks = this->Visit.Blocks;
  status.Fraction = FractionOf(
    doing, std::clamp(share, 0., 1.), this->LastIterations + this->Visit.Iterations);
  this->Stopped = !(this->Listener.*question)(status);
  return !this->Stopped;
}

ProgressQuestion SurfaceEvolution::Implementation::QuestionOf(
  Monitor::Activity doing, double from, double to)
{
  return [this, doing, from, to](double share)
  { return this->GoOn(doing, from + (to - from) * share); };
}

StopReason SurfaceEvolution::Implementation::Evolve()
{
  SurfaceState& s = this->State;
  this->LastIterations = 0;
  this->Rest.Reset();
  this->Cycle.Reset();
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  if (this->HasDescended)
  {
    dynamics.LeaveToRegularisation();
  }
  const double cube = std::pow(static_cast<double>(s.Sizing.OfLevel()), 3);
  while (true)
  {
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
    this->RunSweep(dynamics);
    this->Ask(&Monitor::Continue, Monitor::Activity::Iterating, 1.);
    if (this->Stopped)
    {
      return StopReason::Cancelled;
    }
    if (this->Visit.Active == 0 && s.Mesh.NumberOfVertices() > 0)
    {
      return StopReason::Converged; // Nothing would ever move again.
    }
    if (this->LastIterations % RestCriterion::Interval == 0 && s.Mesh.NumberOfVertices() > 0)
    {
      const double volume = this->Visit.Volume;
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

void SurfaceEvolution::Implementation::FitMeanEdge(const Dynamics& dynamics)
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
  double first = 0.;
  for (int step = 0; step < steps && s.Mesh.NumberOfVertices() > 0; ++step)
  {
    this->GoOn(Monitor::Activity::Regularising, 0.);
    if (this->Stopped)
    {
      break;
    }
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
    this->VisitAll(
      SurfaceIteration::Mode::Regularise, dynamics, 1, Monitor::Activity::Regularising, 0., 0.);
  }
}

void SurfaceEvolution::Implementation::KeepActiveIfMoving(const SurfaceIteration& iteration)
{
  // What went some way in the last pass stays active, with its neighbours, and what was edited.
  SurfaceState& s = this->State;
  const auto moves = [&s](int v)
  {
    const float least = SmallestMove * s.Sizing.At(v);
    return s.Mesh.IsAlive(v) && SquaredLength(s.Velocity[v]) > least * least;
  };
  const std::vector<int>& last = iteration.ActiveVertices();
  for (const int v : last)
  {
    s.Active[v] = s.Active[v] && (s.Disturbed[v] || moves(v));
  }
  for (const int v : last)
  {
    if (moves(v))
    {
      const Ring& ring = s.Mesh.Rings[v];
      std::for_each(ring.Item, ring.Item + ring.Count, [&s](int w) { s.Active[w] = 1; });
    }
  }
}

void SurfaceEvolution::Implementation::RunPasses(const Dynamics& dynamics)
{
  for (int sweep = 0; sweep < RegularisingSweeps && !this->Stopped; ++sweep)
  {
    this->VisitAll(SurfaceIteration::Mode::Regularise, dynamics, SweptPasses,
      Monitor::Activity::Regularising, PassesShare * sweep / RegularisingSweeps,
      PassesShare * (sweep + 1) / RegularisingSweeps);
  }
}

void SurfaceEvolution::Implementation::Polish(const std::function<bool(int v)>& isWanted)
{
  SurfaceState& s = this->State;
  if (this->Stopped)
  {
    return;
  }
  BlockVisits visits;
  visits.OnlyActive = false;
  visits.Doing = Monitor::Activity::Regularising;
  visits.From = PassesShare;
  visits.Visit = [&](BlockVisit& visit, SurfaceIteration&)
  {
    std::vector<int> wanted;
    for (int v = visit.First; v < visit.End(); ++v)
    {
      if (s.Mesh.IsAlive(v) && isWanted(v))
      {
        wanted.push_back(v);
      }
    }
    SurfacePolish polish(s, this->Options.SnapToIsoValue ? this->TheField.get() : nullptr,
      this->Options.TopologyChanges, &visit.Share);
    polish.Run(wanted);
    SurfaceIteration::UpdateChanged(s, polish.TakeChanged());
  };
  this->VisitBlocks(visits);
  const bool hasCut = s.Counts.Cuts > 0;
  this->SinceEvolved.Cuts += s.Counts.Cuts;
  s.Counts = EditCounts();
  if (hasCut)
  {
    this->LabelComponents();
    this->DeleteDegenerate();
    this->SinceEvolved.Removed += s.Counts.Removed;
  }
}

void SurfaceEvolution::Implementation::Regularise(const Dynamics& dynamics)
{
  // The same verified displacements and edits, driven by shape and residual instead of forces.
  SurfaceState& s = this->State;
  const auto forAll = [this, &s](auto&& work)
  {
    this->Threads.For(static_cast<std::size_t>(s.Mesh.Size()), VertexGrain,
      [&](std::size_t begin, std::size_t end)
      {
        for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
        {
          if (s.Mesh.IsAlive(v)) // Other places may take no memory.
          {
            work(v);
          }
        }
      });
  };
  forAll(
    [&s](int v)
    {
      s.Velocity[v] = Vector();
      s.WasActive[v] = s.Active[v];
    });
  this->ActivateAll();
  this->RunPasses(dynamics);
  this->Polish([](int) { return true; });
  forAll(
    [&s](int v)
    {
      s.Active[v] = s.WasActive[v];
      s.Velocity[v] = Vector();
    });
}

void SurfaceEvolution::Implementation::DeleteInsideOut()
{
  this->State.Counts = EditCounts();
  if (this->Unchecked > 0)
  {
    this->DeleteThoseInsideOut();
  }
  this->SinceEvolved.Removed += this->State.Counts.Removed;
}

void SurfaceEvolution::Implementation::FindMissing()
{
  const LostBoundary::Missing missing =
    this->Lost.MissedBy(this->State, this->Area(), *this->TheField, this->Threads);
  this->LastLost.Missing = missing.Parts;
  this->LastLost.MissingBoundary = missing.Share;
}

bool SurfaceEvolution::Implementation::ActivateWhereOff(float least)
{
  SurfaceState& s = this->State;
  const auto n = static_cast<std::size_t>(s.Mesh.Size());
  std::vector<std::uint8_t> isOff(n, 0);
  ForSpans(this->Threads, n, VertexGrain,
    [&](std::size_t, std::size_t begin, std::size_t end)
    {
      for (std::size_t v = begin; v < end; ++v)
      {
        isOff[v] = s.Mesh.IsAlive(static_cast<int>(v)) &&
          this->TheField->IsOff(s.Mesh.Position[v], least * s.Sizing.At(static_cast<int>(v)));
      }
    });
  return CountInSpans(this->Threads, n, VertexGrain,
           [&](std::size_t begin, std::size_t end)
           {
             std::size_t count = 0;
             for (std::size_t v = begin; v < end; ++v)
             {
               if (s.Mesh.IsAlive(static_cast<int>(v)))
               {
                 const Ring& ring = s.Mesh.Rings[v];
                 s.Active[v] = isOff[v] ||
                   std::any_of(ring.Item, ring.Item + ring.Count,
                     [&](int w) { return isOff[static_cast<std::size_t>(w)] != 0; });
                 count += s.Active[v];
               }
             }
             return count;
           }) > 0;
}

void SurfaceEvolution::Implementation::Revise(const LevelImage& image)
{
  /** Residual, in delta, over which a vertex is off the isopotential. */
  constexpr float leastOff = 0.03f;
  SurfaceState& s = this->State;
  this->TheField = std::make_unique<Field>(image, this->Options, this->Threads);
  const bool isAny = this->ActivateWhereOff(leastOff);
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      s.Velocity[v] = Vector();
    }
    s.WasActive[v] = s.Active[v];
  }
  if (!isAny)
  {
    return;
  }
  this->MakeBlocks();
  const Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  this->RunPasses(dynamics);
  this->Polish([&s](int v) { return s.WasActive[v] != 0; });
  this->DeleteInsideOut();
  this->Verify();
  this->ForgetBlocks();
}

StopReason SurfaceEvolution::Implementation::Run()
{
  const StopReason reason = this->Evolve();
  this->DeleteInsideOut();
  if (reason == StopReason::Cancelled || reason == StopReason::Vanished)
  {
      this->Verify();
    this->FinishRow();
    this->FindMissing();
    this->ForgetBlocks();
    return reason;
  }
  HistoryRow none;
  Stopwatch watch(this->HasIteration() ? this->Rows.back() : none);
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  if (this->WantedMeanEdge > 0.)
  {
    this->FitMeanEdge(dynamics);
  }
  const bool isGraded = this->WantedGrading.HasTolerance() && !this->Stopped &&
    this->State.Mesh.NumberOfVertices() > 0;
  if (isGraded)
  {
    this->FindMissing(); // Before: it asks for vertices that are near.
    this->Grade(dynamics);
  }
  this->Regularise(dynamics);
  this->DeleteInsideOut(); // The polish may have cut.
  this->Verify();
  this->FinishRow();
  watch.Lap(Phase::Regularisation);
  if (!isGraded)
  {
    this->FindMissing();
  }
  this->ForgetBlocks();
  watch.Lap(Phase::Recovery);
  if (this->Stopped)
  {
    return StopReason::Cancelled;
  }
  return this->State.Mesh.NumberOfVertices() > 0 ? reason : StopReason::Vanished;
}
}

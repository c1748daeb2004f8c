// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceEvolution.h"

#include "Core/Common/FreeMemory.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Surface/NewFaces.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace volumic
{
namespace
{
/** Number of iterations at which the estimated progress of a level reaches 1 - 1/e. */
constexpr double TypicalIterations = 80.;
/** Progress of a level before and after its iterations. */
constexpr double ShareBefore = 0.1;
constexpr double ShareAfter = 0.2;

/** Return the progress of a level, in [0, 1]. */
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
        (1. - ShareBefore - ShareAfter) *
        (1. - std::exp(-(iterations + share) / TypicalIterations));
    default:
      return 1. - ShareAfter * (1. - share);
  }
}

void CheckRange(const char* name, double value, double low, double high)
{
  if (!(value >= low && value <= high))
  {
    ThrowInvalidArgument(name, " is ", value, ", it must lie in [", low, ", ", high, "].");
  }
}
}

const char* Describe(StopReason reason)
{
  switch (reason)
  {
    case StopReason::Converged:
      return "converged";
    case StopReason::LimitCycle:
      return "limit cycle";
    case StopReason::IterationLimit:
      return "iteration limit";
    case StopReason::Cancelled:
      return "cancelled";
    default:
      return "vanished";
  }
}

std::string Verdict::Describe(int level) const
{
  return "The surface of level " + std::to_string(level) + " intersected itself at " +
    std::to_string(this->Found) +
    (this->Left > 0 ? " vertices, and does so still: it could not be mended."
                    : " vertices; it has got another mesh, whose triangles are less even.") +
    " This is an error of Volumic: please report it, with the volume.";
}

void CheckOptions(const SurfaceOptions& options)
{
  CheckRange("Sampling Ratio", options.SamplingRatio, SizingField::LeastSamplingRatio - 1e-6, 1.);
  for (const WeightOfForce& weight : WeightsOfForces)
  {
    CheckRange(weight.Name, options.*weight.Value, 0., 1e6);
  }
  CheckRange("Friction", options.Friction, 1e-6, 1e6);
  CheckRange("Seed Radius", options.SeedRadius, 0., 1e9);
  CheckRange("Convergence Tolerance", options.ConvergenceTolerance, 0., 1.);
  CheckRange("MaximumStep", options.MaximumStep, 1e-3, 0.5);
}

bool Evolution::GoOn(Monitor::Activity doing, double share)
{
  if (!this->Stopped)
  {
    this->Status.Doing = doing;
    this->Status.Iteration = this->History.Iterations();
    this->Status.Vertices =
      this->Blocks ? this->Blocks->NumberOfVertices() : this->State.Mesh.NumberOfVertices();
    this->Status.Fraction = std::clamp(FractionOf(doing, share, this->Status.Iteration), 0., 1.);
    this->Stopped = !this->Listener->GoOn(this->Status);
  }
  return !this->Stopped;
}

ProgressCallback Evolution::ProgressCallbackOf(Monitor::Activity doing, double from, double to)
{
  return [this, doing, from, to](double share)
  { return this->GoOn(doing, from + (to - from) * std::clamp(share, 0., 1.)); };
}

void Evolution::Observe()
{
  if (this->Task.Observe)
  {
    const auto take = [this] {
      return CountIntersecting(this->State, this->Threads) == 0 ? this->Result() : SurfaceResult();
    };
    this->Task.Observe(this->History.Iterations(), take);
  }
}

SurfaceResult Evolution::Result()
{
  return MakeResult(this->State, *this->TheField, this->Task.Grading, this->Threads);
}

void Evolution::MakeField()
{
  this->TheField = std::make_unique<Field>(this->Task.Image, this->Task.Options, this->Threads);
  this->Motion = std::make_unique<Dynamics>(*this->TheField, this->Task.Options, this->Threads);
}

LevelOutcome EvolveOnLevel(
  const LevelTask& task, ConvergedSurface& converged, Executor& executor, Monitor& monitor)
{
  Evolution e(task, converged.History, executor, monitor);
  LevelOutcome outcome;
  outcome.HasReachedLevel = ReachLevel(e, converged);
  if (!outcome.HasReachedLevel)
  {
    return outcome;
  }
  GiveBackFreeMemory();
  e.Observe();
  outcome.Reason = RunLevel(e);
  e.State.ReleaseMotion(); // Frees memory for the result.
  GiveBackFreeMemory();
  outcome.Surface = e.Result();
  outcome.Reason = e.Stopped ? StopReason::Cancelled : outcome.Reason;
  outcome.Iterations = e.History.Iterations();
  outcome.Missed = e.Missed;
  outcome.Verified = e.Verified;
  converged.Mesh = std::move(e.State.Mesh);
  converged.Level = task.Level;
  converged.Delta = e.State.Sizing.OfLevel();
  converged.Unchecked = e.Unchecked;
  return outcome;
}
}

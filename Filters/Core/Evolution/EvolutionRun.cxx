// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Spans.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/ConvergenceCriterion.h"
#include "Core/Evolution/CycleCriterion.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Surface/NewFaces.h"
#include "Core/Surface/SurfaceOptimization.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Fraction of the passes in a regularisation; the rest is the optimization. */
constexpr double PassesShare = 0.6;
/** Sweeps of the regularisation, and passes per block. */
constexpr int RegularisingSweeps = 3;
constexpr int SweptPasses = 4;
/** Vertices per span of a parallel loop. */
constexpr std::size_t VertexGrain = 2048;

StopReason Evolve(Evolution& e)
{
  const SurfaceOptions& options = e.Task.Options;
  const SurfaceMesh& mesh = e.State.Mesh;
  ConvergenceCriterion convergence;
  CycleCriterion cycle;
  if (e.HasDescended)
  {
    e.Motion->LeaveToRegularisation();
  }
  const double cube = std::pow(static_cast<double>(e.State.Sizing.OfLevel()), 3);
  while (!e.Stopped)
  {
    if (mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
    if (e.History.Iterations() >= options.MaximumNumberOfIterations)
    {
      return StopReason::IterationLimit;
    }
    RunSweep(e);
    e.Observe();
    if (!e.GoOn(Monitor::Activity::Iterating, 0.) || mesh.NumberOfVertices() == 0)
    {
      continue;
    }
    if (e.Status.ActiveVertices == 0)
    {
      return StopReason::Converged; // No vertex would ever move again.
    }
    if (e.History.Iterations() % ConvergenceCriterion::Interval == 0)
    {
      const double volume = VolumeOf(e);
      const double limit = std::max(cube, options.ConvergenceTolerance * std::abs(volume));
      convergence.Add(volume);
      cycle.Add(volume);
      if (convergence.IsMet(limit))
      {
        return StopReason::Converged;
      }
      if (cycle.IsMet(limit))
      {
        return StopReason::LimitCycle;
      }
    }
  }
  return StopReason::Cancelled;
}

void FitMeanEdge(Evolution& e)
{
  // All edges in [delta, 2.5 delta] are legal, so their mean depends on the history. A slow change
  // of delta collapses or splits the worst edges first.
  constexpr int steps = 30;
  constexpr double close = 0.02;
  constexpr double share = 0.6; // fraction of the difference per step
  constexpr double longestStep = 0.03;
  SurfaceState& s = e.State;
  const double unit = e.Task.Image.Unit;
  const float least = static_cast<float>(SizingField::LeastSamplingRatio * unit);
  const float most = static_cast<float>(unit);
  double first = 0.;
  for (int step = 0; step < steps && s.Mesh.NumberOfVertices() > 0; ++step)
  {
    if (!e.GoOn(Monitor::Activity::Regularising, 0.))
    {
      break;
    }
    const double missing = e.Task.MeanEdgeLength / NumbersOf(e).MeanEdgeLength - 1.;
    first = step == 0 ? missing : first;
    const double change = std::min(std::max(share * missing, -longestStep), longestStep);
    const float old = s.Sizing.OfLevel();
    const float delta = std::min(std::max(old * static_cast<float>(1. + change), least), most);
    if (std::abs(missing) < close || missing * first < 0. || delta == old)
    {
      break;
    }
    s.Sizing = SizingField(delta);
    Renumber(e);
    s.Velocity.Fill(Vector());
    Relax(e, SurfaceIteration::Mode::Regularise, 1, { Monitor::Activity::Regularising, 0., 0. });
  }
}

void Optimize(Evolution& e)
{
  SurfaceState& s = e.State;
  const SurfaceOptions& options = e.Task.Options;
  if (e.Stopped)
  {
    return;
  }
  RunBlockPasses(e, { Monitor::Activity::Regularising, PassesShare, 1., false },
    [&](BlockPass& pass)
    {
      std::vector<int> requested;
      for (int v = pass.First; v < pass.End(); ++v)
      {
        if (s.Mesh.IsAlive(v))
        {
          requested.push_back(v);
        }
      }
      const bool snaps = options.Drive().SnapsTo == SurfaceDrive::Goal::IsoValue;
      SurfaceOptimization optimize(
        s, snaps ? e.TheField.get() : nullptr, options.TopologyChanges, &pass.Context);
      optimize.Run(requested);
      SurfaceIteration::UpdateChanged(s, optimize.TakeChanged());
    });
  if (s.Counts.Cuts > 0)
  {
    LabelComponents(e);
    e.Components.DeleteDegenerate(s, e.Threads);
  }
}

void Regularise(Evolution& e)
{
  // Uses the verified displacements and edits of an iteration, but shape and residual as forces.
  SurfaceState& s = e.State;
  ForAlive(s.Mesh, e.Threads,
    [&s](int v)
    {
      s.Velocity[v] = Vector();
      s.WasActive[v] = s.Active[v];
    });
  ActivateAll(e);
  for (int sweep = 0; sweep < RegularisingSweeps && !e.Stopped; ++sweep)
  {
    Relax(e, SurfaceIteration::Mode::Regularise, SweptPasses,
      { Monitor::Activity::Regularising, PassesShare * sweep / RegularisingSweeps,
        PassesShare * (sweep + 1) / RegularisingSweeps });
  }
  Optimize(e);
  ForAlive(s.Mesh, e.Threads,
    [&s](int v)
    {
      s.Active[v] = s.WasActive[v];
      s.Velocity[v] = Vector();
    });
}

void DeleteThoseInsideOut(Evolution& e)
{
  if (e.Unchecked > 0)
  {
    DeleteInsideOut(e);
  }
}

void MeasureMissedBoundary(Evolution& e)
{
  const MissedBoundary::Missing missing =
    e.Boundary.MissedBy(e.State, AreaOf(e), *e.TheField, e.Threads);
  e.Missed.Missing = missing.Parts;
  e.Missed.MissingBoundary = missing.Share;
}

/** Final intersection test of a level. SurfaceIteration explains why it should find nothing. */
void Verify(Evolution& e)
{
  e.Verified.Found = static_cast<int>(CountIntersecting(e.State, e.Threads));
  e.Verified.Left = 0;
  if (e.Verified.Found == 0)
  {
    return;
  }
  ForgetBlocks(e);
  const SurfaceMesh before = e.State.Mesh;
  e.State.Sizing = SizingField(e.State.Sizing.OfLevel()); // The new mesh is uniform.
  Monitor nobody;                                         // Remeshing cannot be cancelled.
  Monitor* const listener = std::exchange(e.Listener, &nobody);
  const bool wasStopped = std::exchange(e.Stopped, false);
  try
  {
    TakeRemeshed(e, before.ToIndexed(e.Threads));
  }
  catch (const InvalidArgument&) // The remeshed surface is too thin or too small for the level.
  {
    e.State.Mesh = before;
    LayGrid(e);
    MakeBlocks(e);
    LabelComponents(e);
    e.Verified.Left = e.Verified.Found;
  }
  e.Listener = listener;
  e.Stopped = wasStopped;
}

/** Finish a level with a converged surface. */
void Finish(Evolution& e)
{
  if (e.Task.MeanEdgeLength > 0.)
  {
    FitMeanEdge(e);
  }
  const bool isGraded =
    e.Task.Grading.HasTolerance() && !e.Stopped && e.State.Mesh.NumberOfVertices() > 0;
  if (isGraded)
  {
    MeasureMissedBoundary(e); // Before grading, because it tests for near vertices.
    Grade(e);
  }
  Regularise(e);
  DeleteThoseInsideOut(e); // The optimization may have cut.
  Verify(e);
  e.History.Finish(NumbersOf(e));
  if (!isGraded)
  {
    MeasureMissedBoundary(e);
  }
  ForgetBlocks(e);
}
}

bool ActivateWhereOff(Evolution& e, float least)
{
  SurfaceState& s = e.State;
  const auto n = static_cast<std::size_t>(s.Mesh.Size());
  std::vector<std::uint8_t> isOff(n, 0);
  ForAlive(s.Mesh, e.Threads,
    [&](int v) { isOff[v] = e.TheField->IsOff(s.Mesh.Position[v], least * s.Sizing.At(v)); });
  return CountInSpans(e.Threads, n, VertexGrain,
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

StopReason RunLevel(Evolution& e)
{
  const StopReason reason = Evolve(e);
  DeleteThoseInsideOut(e);
  if (reason == StopReason::Cancelled || reason == StopReason::Vanished)
  {
    Verify(e);
    e.History.Finish(NumbersOf(e));
    MeasureMissedBoundary(e);
    ForgetBlocks(e);
    return reason;
  }
  Finish(e);
  if (e.Stopped)
  {
    return StopReason::Cancelled;
  }
  return e.State.Mesh.NumberOfVertices() > 0 ? reason : StopReason::Vanished;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Block passes (see SurfaceBlocks), and sums over blocks.

#include "Core/Evolution/ConvergenceCriterion.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/Remesher.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** Iterations per block pass, which is the sampling interval of the volume. */
constexpr int SweptIterations = ConvergenceCriterion::Interval;
/** Sweeps between two tests for inverted components. */
constexpr int InsideOutSweeps = 2;
/** Displacement in a pass, in delta, below which a vertex is deactivated; and for large surfaces.
 */
constexpr float SmallestMove = 0.015f;
constexpr float SmallestMoveOfLarge = 0.04f;
constexpr int LargeSurface = 20000;

/** Keep moved and edited vertices and their neighbours active, deactivate all others. */
void KeepActiveIfMoving(SurfaceState& s, const SurfaceIteration& iteration, float smallestMove)
{
  const auto moves = [&s, smallestMove](int v)
  {
    const float least = smallestMove * s.Sizing.At(v);
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
}

void MakeBlocks(Evolution& e)
{
  ForgetBlocks(e);
  const LevelImage& image = e.Task.Image;
  std::array<double, 3> extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[axis] = image.Size[axis] * image.Step[axis];
  }
  const double requested = e.Task.Options.BlockSide;
  const double side = requested > 0. ? requested : SurfaceBlocks::SideInDelta;
  e.Blocks = std::make_unique<SurfaceBlocks>(
    e.State, SurfaceBlocks::FrameOf(extent, side * e.State.Sizing.Largest()), e.Threads);
}

void ForgetBlocks(Evolution& e)
{
  e.Components = SurfaceComponents();
  e.Blocks.reset();
}

void RunBlockPasses(
  Evolution& e, const Sweep& sweep, const std::function<void(BlockPass& pass)>& run)
{
  e.State.Counts = EditCounts();
  e.Blocks->Prepare(e.Threads);
  std::mutex counting;
  const auto visitBlock = [&](int block)
  {
    if (sweep.OnlyActive && !e.Blocks->HasActive(block))
    {
      return;
    }
    BlockPass opened = e.Blocks->Open(block);
    {
      const std::lock_guard<std::mutex> lock(counting);
      opened.Large = e.Components.Large();
    }
    run(opened);
    const EditCounts counts = opened.Context.Counts;
    e.Blocks->Close(std::move(opened));
    const std::lock_guard<std::mutex> lock(counting);
    e.State.Counts += counts;
    e.Components.Note(counts);
    e.Unchecked += counts.Cuts + counts.Removed;
  };
  e.Status.Blocks = e.Blocks->NumberOfBlocks();
  const auto goOn = [&](std::size_t done)
  {
    e.Status.Block = static_cast<int>(done);
    return !sweep.IsMonitored ||
      e.GoOn(sweep.Doing, sweep.From + (sweep.To - sweep.From) * e.Status.Block / e.Status.Blocks);
  };
  e.Blocks->Schedule().Run(e.Threads, visitBlock, goOn);
  e.Status.Block = 0;
}

void RunSweep(Evolution& e)
{
  SurfaceState& s = e.State;
  const SurfaceOptions& options = e.Task.Options;
  const int iterations =
    std::min(SweptIterations, options.MaximumNumberOfIterations - e.History.Iterations());
  const Field* evidence = options.Drive().HasObject ? e.TheField.get() : nullptr;
  SweptRows swept(iterations, e.Blocks->NumberOfBlocks());
  e.History.BeginSweep(s.Mesh.NumberOfVertices(), s.EulerCharacteristic);
  ++e.Status.Sweep;
  RunBlockPasses(e, { Monitor::Activity::Iterating, 0., static_cast<double>(iterations) },
    [&](BlockPass& pass)
    {
      SurfaceIteration iteration(s, pass, evidence, options.TopologyChanges, e.Threads);
      std::vector<HistoryRow> rows;
      for (int i = 0; i < iterations; ++i)
      {
        rows.push_back(iteration.Run(*e.Motion, SurfaceIteration::Mode::Evolve));
      }
      swept.Add(pass.Block, rows);
    });

  const EditCounts& counts = s.Counts;
  const bool hasChanged = e.Status.Sweep == 1 || counts.Merges + counts.Cuts + counts.Removed > 0;
  if (e.Status.Sweep % InsideOutSweeps == 0 && e.Unchecked > 0)
  {
    DeleteInsideOut(e);
  }
  else if (hasChanged)
  {
    LabelComponents(e);
  }
  e.Status.ActiveVertices = swept.Rows.back().ActiveVertices;
  e.History.EndSweep(swept, NumbersOf(e));
}

void Relax(Evolution& e, SurfaceIteration::Mode mode, int iterations, const Sweep& sweep)
{
  SurfaceState& s = e.State;
  const float smallestMove =
    s.Mesh.NumberOfVertices() < LargeSurface ? SmallestMove : SmallestMoveOfLarge;
  RunBlockPasses(e, sweep,
    [&](BlockPass& pass)
    {
      SurfaceIteration iteration(s, pass, e.TheField.get(), false, e.Threads);
      for (int i = 0; i < iterations; ++i)
      {
        for (int v = pass.First; v < pass.End(); ++v)
        {
          s.Disturbed[v] = 0;
        }
        iteration.Run(*e.Motion, mode);
        if (mode != SurfaceIteration::Mode::Adapt)
        {
          KeepActiveIfMoving(
            s, iteration, smallestMove); // Also outside the block, for later passes.
        }
      }
      for (int v = pass.First; v < pass.End(); ++v)
      {
        s.Velocity[v] = Vector();
      }
    });
}

void SplitLongEdges(Evolution& e, Sweep sweep)
{
  // Verification requires that no edge is longer than eq. (1) allows. An edge whose split would
  // create needles stays, and its ends do not move, as in an iteration: see HasHugeEdge().
  sweep.OnlyActive = false;
  // Repeated, because a block may lack free slots, and halves of split edges may be too long.
  do
  {
    RunBlockPasses(e, sweep,
      [&e](BlockPass& pass)
      {
        Remesher remesher(e.State, nullptr, false, &pass.Context);
        std::vector<int> vertices(static_cast<std::size_t>(pass.End() - pass.First));
        std::iota(vertices.begin(), vertices.end(), pass.First);
        remesher.Split(vertices);
        SurfaceIteration::UpdateChanged(e.State, remesher.TakeChanged());
      });
  } while (!(sweep.IsMonitored && e.Stopped) && e.State.Counts.Splits > 0 && HasEdgeTooLong(e));
}

void LabelComponents(Evolution& e)
{
  e.Components.Label(e.State, e.Threads);
}

void DeleteInsideOut(Evolution& e)
{
  e.Components.DeleteInsideOut(e.State, e.Threads);
  e.Unchecked = 0;
}

SurfaceNumbers NumbersOf(const Evolution& e)
{
  const SurfaceState& s = e.State;
  const int vertices = s.Mesh.NumberOfVertices();
  const double lengths = e.Blocks->SumUp([&s](int v) { return s.EdgeLengthSum[v]; }, e.Threads);
  const std::int64_t edges = NumberOfEdges(vertices, s.EulerCharacteristic);
  // Each edge is counted twice.
  return { vertices, s.EulerCharacteristic, e.Components.NumberOfComponents(),
    edges > 0 ? lengths / (2. * static_cast<double>(edges)) : 0. };
}

double AreaOf(const Evolution& e)
{
  const SurfaceMesh& mesh = e.State.Mesh;
  return e.Blocks->SumUp([&mesh](int v) { return VertexArea(mesh, v); }, e.Threads);
}

double VolumeOf(const Evolution& e)
{
  const SurfaceMesh& mesh = e.State.Mesh;
  const Vector origin = e.Blocks->GetFrame().Low;
  return e.Blocks->SumUp(
    [&mesh, origin](int v)
    {
      SignedVolume share(origin);
      share.Add(mesh, v);
      return share.Value();
    },
    e.Threads);
}
}

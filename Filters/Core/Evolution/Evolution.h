// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolution_h
#define volumicEvolution_h

#include "Core/Evolution/Dynamics.h"
#include "Core/Evolution/MissedBoundary.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceComponents.h"
#include "Core/Surface/SurfaceState.h"

#include <functional>
#include <memory>
#include <vector>

namespace volumic
{
// Parts of EvolveOnLevel(). Functions run on its calling thread, except those that a block pass
// calls.

/** State of the evolution on a level. */
struct Evolution
{
  Evolution(const LevelTask& task, EvolutionHistory& history, Executor& executor, Monitor& monitor)
    : Task(task), Threads(executor), Listener(&monitor), History(history)
  {
  }

  const LevelTask Task;
  Executor& Threads;
  Monitor* Listener;
  bool Stopped = false;   ///< cancelled by the listener, which is not called again
  Monitor::Status Status; ///< last report to the listener
  EvolutionHistory& History;
  SurfaceState State;
  std::unique_ptr<Field> TheField;
  std::unique_ptr<Dynamics> Motion;
  std::unique_ptr<SurfaceBlocks> Blocks; ///< null before the surface is at the level
  SurfaceComponents Components;          ///< as labelled last
  int Unchecked = 1; ///< starts, cuts and deletions since the last test for inverted components
  MissedParts Missed;
  MissedBoundary Boundary;   ///< of the parts missed by the coarser level
  bool HasDescended = false; ///< see DescendField()
  Verdict Verified;

  /**
   * Report the fraction done of an activity (for iterations: their number in the sweep). Return
   * false if the run is cancelled.
   */
  bool GoOn(Monitor::Activity doing, double share);
  /** Return a callback that maps fractions in [0, 1] to [from, to] of the activity. */
  ProgressCallback ProgressCallbackOf(Monitor::Activity doing, double from = 0., double to = 1.);
  /** Create TheField from the current voxels. */
  void MakeField();
  /** Call Task.Observe, between sweeps. */
  void Observe();
  SurfaceResult Result();
};

// EvolutionStart.cxx: start on a level.

/** Start or divide the surface. @return false if cancelled before any change of `converged` */
bool ReachLevel(Evolution& evolution, ConvergedSurface& converged);
/** Discard all but the mesh, renumber its vertices along a space-filling curve, call LayOut(). */
void Renumber(Evolution& evolution);
/** Compute grid, blocks and labels of a mesh; split long edges. */
void LayOut(Evolution& evolution);
void LayGrid(Evolution& evolution);
void ActivateAll(Evolution& evolution);

/** Call work(v) for all vertices in parallel. */
template <typename Work>
void ForAlive(const SurfaceMesh& mesh, Executor& executor, const Work& work)
{
  constexpr std::size_t grain = 2048;
  executor.For(static_cast<std::size_t>(mesh.Size()), grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (mesh.IsAlive(v)) // Unused slots may take no memory.
        {
          work(v);
        }
      }
    });
}
std::vector<int> AliveVertices(const Evolution& evolution);

// InitialSurfaceCheck.cxx: check and remesh an initial surface.

void TakeGiven(Evolution& evolution, const IndexedSurface& surface);
void TakeRemeshed(Evolution& evolution, const IndexedSurface& surface);

// EvolutionDivision.cxx: subdivide to the edge length of the level.

/**
 * Move the surface of the coarser level onto the isosurface of this one by verified passes, before
 * the division triples the number of vertices. @param delta of the coarser level
 */
void DescendField(Evolution& evolution, double delta);
/** @return false if cancelled */
bool DivideAll(Evolution& evolution, int divisions);
bool HasEdgeTooLong(const Evolution& evolution);

// EvolutionGrading.cxx: local division, and graded edge lengths.

/**
 * Subdivide only where this level requires shorter edges. @param delta of the coarser level
 * @return false if a tolerance requires them at more than half of the vertices: call DivideAll()
 * and LayOut() then
 */
bool DivideWhereRequested(Evolution& evolution, double delta);
/** Subdivide near missed parts, to leave room for recovery surfaces. */
void DivideNear(Evolution& evolution, const MissedBoundary& missed);
void Grade(Evolution& evolution);

// EvolutionPasses.cxx: block passes, and sums over blocks.

/** Options of a sweep over all blocks. */
struct Sweep
{
  Monitor::Activity Doing = Monitor::Activity::Iterating;
  double From = 0.;        ///< fraction of the activity done before the sweep
  double To = 1.;          ///< and after it
  bool OnlyActive = true;  ///< Skip blocks without active vertices.
  bool IsMonitored = true; ///< Report to the listener, which may cancel.
};

void MakeBlocks(Evolution& evolution);
void ForgetBlocks(Evolution& evolution); ///< Call it before the mesh is renumbered.
/**
 * Call run(pass) for each block, on any thread, and add the counters of its edits to State.Counts.
 * If cancelled, some blocks have no pass; the surface is valid nevertheless.
 */
void RunBlockPasses(
  Evolution& evolution, const Sweep& sweep, const std::function<void(BlockPass& pass)>& run);
/** Run a sweep of iterations with rows in the history, and label the components. */
void RunSweep(Evolution& evolution);
/** Run iterations without rows in the history, in blocks with active vertices. */
void Relax(Evolution& evolution, SurfaceIteration::Mode mode, int iterations, const Sweep& sweep);
/** Split all edges that are too long. If cancelled, some remain. */
void SplitLongEdges(Evolution& evolution, Sweep sweep);
void LabelComponents(Evolution& evolution);
/** Delete components that are inside out, and label the others. */
void DeleteInsideOut(Evolution& evolution);
SurfaceNumbers NumbersOf(const Evolution& evolution);
double VolumeOf(const Evolution& evolution);
double AreaOf(const Evolution& evolution);

// EvolutionRun.cxx: evolve until convergence.

/**
 * Activate vertices farther than `least` (in delta) from the isosurface, and their neighbours;
 * deactivate all others. @return whether there are any
 */
bool ActivateWhereOff(Evolution& evolution, float least);
/**
 * Run sweeps until one of the stop reasons applies. Then finish the level: optimize and verify the
 * surface, and delete components that are inside out. Also finishes a cancelled level.
 */
StopReason RunLevel(Evolution& evolution);
}

#endif

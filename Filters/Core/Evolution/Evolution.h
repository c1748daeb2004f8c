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
// What EvolveOnLevel() is made of. All is called on the thread that calls it, but for what a visit
// calls, which is called on any thread.

/** A surface on its way on a level, and what its steps share. */
struct Evolution
{
  Evolution(const LevelTask& task, EvolutionHistory& history, Executor& executor, Monitor& monitor)
    : Task(task), Threads(executor), Listener(&monitor), History(history)
  {
  }

  const LevelTask Task;
  Executor& Threads;
  Monitor* Listener;
  bool Stopped = false;   ///< The listener has said stop; it is not asked again.
  Monitor::Status Status; ///< As it was told last.
  EvolutionHistory& History;
  SurfaceState State;
  std::unique_ptr<Field> TheField;
  std::unique_ptr<Dynamics> Motion;      ///< In the field.
  std::unique_ptr<SurfaceBlocks> Blocks; ///< While the surface lies on a level, else null.
  SurfaceComponents Components;          ///< As they were labelled last.
  int Unchecked = 1; ///< Starts, cuts and deletions since components were judged from outside in.
  MissedParts Missed;
  MissedBoundary Boundary;   ///< Of the parts that were lost when it came to the level.
  bool HasDescended = false; ///< See DescendField.
  Verdict Verified;

  /**
   * The one question of all work on a level: the share of an activity that is done, of iterations
   * how many of the sweep's.
   */
  bool GoOn(Monitor::Activity doing, double share);
  /** The same for work whose own shares lie between two of the activity's. */
  ProgressCallback ProgressCallbackOf(Monitor::Activity doing, double from = 0., double to = 1.);
  /** Of the voxels as they are now. */
  void MakeField();
  /** Between sweeps. */
  void Observe();
  SurfaceResult Result();
};

// EvolutionStart.cxx: comes to a level.

/** @return false if it was stopped before anything was done: the rest is as it was */
bool ReachLevel(Evolution& evolution, ConvergedSurface& rest);
/** Forgets all but the mesh, numbers its vertices along a curve, and lays it out. */
void Renumber(Evolution& evolution);
/** Makes grid, blocks and labels of a mesh of which nothing else is known; splits long edges. */
void LayOut(Evolution& evolution);
void LayGrid(Evolution& evolution);
void ActivateAll(Evolution& evolution);

/** Call work(v) for all vertices that are alive, on several threads. */
template <typename Work>
void ForAlive(const SurfaceMesh& mesh, Executor& executor, const Work& work)
{
  constexpr std::size_t grain = 2048;
  executor.For(static_cast<std::size_t>(mesh.Size()), grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      {
        if (mesh.IsAlive(v)) // Other places may take no memory.
        {
          work(v);
        }
      }
    });
}
std::vector<int> AliveVertices(const Evolution& evolution);

// InitialSurfaceCheck.cxx: makes a given surface ready.

void TakeGiven(Evolution& evolution, const IndexedSurface& surface);
/** Another mesh of it. */
void TakeRemeshed(Evolution& evolution, const IndexedSurface& surface);

// EvolutionDivision.cxx: to the next level's edge lengths.

/**
 * Before a division: from the isopotential of the level before onto that of this one, as far as
 * verified passes lead, while there are a third as many vertices. @param delta of the level before
 */
void DescendField(Evolution& evolution, double delta);
/** @return whether nothing asked to stop */
bool DivideAll(Evolution& evolution, int divisions);
bool HasEdgeTooLong(const Evolution& evolution);

// EvolutionGrading.cxx: divides here and there, and makes edges longer where it is flat.

/**
 * From a level of this delta: only where what is seen on the new one asks for shorter edges.
 * @return false where a tolerance asks for them at more than half of the vertices: then all is to
 * be divided, and laid out
 */
bool DivideWhereRequested(Evolution& evolution, double delta);
/** The same about parts that are lost, so that these can be enclosed beside it. */
void DivideNear(Evolution& evolution, const MissedBoundary& missed);
void Grade(Evolution& evolution);

// EvolutionPasses.cxx: visits of blocks, and sums over them.

/** A sweep over blocks. */
struct Sweep
{
  Monitor::Activity Doing = Monitor::Activity::Iterating;
  double From = 0.;        ///< The share of the activity that is done before the sweep, and
  double To = 1.;          ///< after it.
  bool OnlyActive = true;  ///< Blocks in which nothing may move are left out.
  bool IsMonitored = true; ///< The listener is told, and may stop it.
};

void MakeBlocks(Evolution& evolution);   ///< Those of the mesh as it is.
void ForgetBlocks(Evolution& evolution); ///< Before the mesh is numbered otherwise.
/**
 * After a stop some blocks were not visited; the surface is valid all the same. State.Counts is
 * then the sum of what the visits have edited. @param visit called on any thread
 */
void RunBlockPasses(
  Evolution& evolution, const Sweep& sweep, const std::function<void(BlockPass& visit)>& visit);
/** A few iterations of evolution, which the history tells of; labels the components. */
void RunSweep(Evolution& evolution);
/** Some iterations in each block with active vertices; the history has no rows of them. */
void Relax(Evolution& evolution, SurfaceIteration::Mode mode, int iterations, const Sweep& sweep);
/** Splits all edges that are too long. @param sweep after a stop some long edges are left */
void SplitLongEdges(Evolution& evolution, Sweep sweep);
void LabelComponents(Evolution& evolution);
/** Labels them, too. */
void DeleteInsideOut(Evolution& evolution);
SurfaceNumbers NumbersOf(const Evolution& evolution);
double VolumeOf(const Evolution& evolution);
double AreaOf(const Evolution& evolution);

// EvolutionRun.cxx: until it rests.

/**
 * Makes those active that are further than this (in delta) off the isopotential, and those beside
 * them; all others rest. @return whether there are any
 */
bool ActivateWhereOff(Evolution& evolution, float least);
/**
 * Sweeps until the level rests, goes in circles, has had its iterations, vanishes or is stopped,
 * and then what ends a level, also after a stop: nothing inside out or unverified stays.
 */
StopReason RunLevel(Evolution& evolution);
}

#endif

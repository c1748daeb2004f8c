// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceIteration_h
#define volumicSurfaceIteration_h

#include "Core/Evolution/Dynamics.h"
#include "Core/Evolution/EvolutionHistory.h"
#include "Core/Surface/ComponentWatch.h"
#include "Core/Surface/Proximity.h"
#include "Core/Surface/Remesher.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceState.h"

#include <vector>

namespace volumic
{
/**
 * The iterations of a visit: velocities, displacement, splits, verification with roll back, merges
 * and cuts, the other edits, components that must go. It keeps what one iteration tells the next:
 * which pairs of vertices are close, which components are small. Before and after each call the
 * surface is closed, oriented, manifold and, under the bound below, free of intersections.
 * Sequential, but for forces, shapes and the search for what is near, in which idle threads share;
 * others may be at work in visits of blocks that do not touch this one.
 *
 * Why it stays free of them, by what changes the mesh:
 * - Splits change no place of the surface, but for rounding, less than SizingField::Contact. They
 *   come first and last, so that no edge is longer than eq. (1) allows when anything is looked for.
 * - Collapses, flips, removals, moves, merges and cuts: SurfaceEditor tests each new face
 *   against all that it can reach (NewFacesIntersect), before it edits; none is left out.
 * - Displacements: Proximity tests what is within reach and faces the other way, or is a
 *   star that may be folded. Where two parts of a surface first meet in the course of it, each lies
 *   on its own side of the surface, so a plane touches both and parts them: a normal of one is the
 *   opposite of one of the other, if those of an edge or a corner are all between those of its
 *   faces, which are in its cone. The cones are compared with 30 degrees to spare
 *   (SurfaceState::AreOpposed), for what normals turn from there to the end of the displacement,
 *   half a delta at most. What intersects is rolled back, and more about it, in the last round all:
 *   that is the mesh of before, which needs no test.
 * - Deletions take whole components away.
 * Divisions are tested like displacements. The tests are conservative (TrianglesIntersect). The
 * bound of 30 degrees is an observation: so all faces are tested against all others, whatever their
 * normals are, wherever a surface is handed out: a given start, a snapshot, the end of a level and
 * a run that was stopped (CountIntersecting).
 */
class SurfaceIteration
{
public:
  /** What drives it: forces; residual and shape, by long ways or by short ones; shape alone. */
  enum class Mode
  {
    Evolve,
    Descend,
    Regularise,
    Adapt
  };

  /**
   * Works on the vertices of a visit, which must have a shape that is up to date; all others keep
   * still, as if they were not active. Components are watched that are small and lie where the
   * visit may write.
   * @param evidence, topologyChanges see Remesher
   */
  SurfaceIteration(SurfaceState& state, BlockPass& visit, const Field* evidence,
    bool topologyChanges, Executor& threads = OnThisThread());
  ~SurfaceIteration();
  SurfaceIteration(const SurfaceIteration&) = delete;
  SurfaceIteration& operator=(const SurfaceIteration&) = delete;

  /**
   * @return what it has done; of vertices and Euler characteristic, by how many there are more
   */
  HistoryRow Run(const Dynamics& dynamics, Mode mode);

  /** The vertices that the last iteration has found active. */
  const std::vector<int>& ActiveVertices() const { return this->Active; }

  /** After edits: shape of the vertices, and that their stars must be examined again. */
  static void UpdateChanged(SurfaceState& state, std::vector<int> changed);

private:
  /** Displaces the active vertices, verifies that, and rolls back. */
  void Move(const Dynamics& dynamics, Mode mode);
  void CollectActive();
  void CollectWorking();
  void AddUnmoved(int v);
  bool IsDirty(int v) const;
  void CollectDirtyVertices();
  void RollBack();
  void RollBackVertex(int v);
  void SplitBeforeVerification();
  void RestoreConstraints();
  void WatchComponents();
  double KineticEnergy() const;

  SurfaceState& State;
  BlockPass& Visit;
  Executor& Threads;
  Remesher Edits;
  Proximity Near;    ///< Of all; keeps the pairs.
  Proximity Recheck; ///< Of what has been rolled back.
  ComponentWatch Watch;
  Dynamics::Step Step;
  std::vector<int> Active;
  std::vector<int> Working;       ///< See CollectWorking; they have the mark IsWorking.
  std::vector<int> DirtyVertices; ///< See CollectDirtyVertices.
  EditCounts Labelled;            ///< Of the share, when components were labelled.
};
}

#endif

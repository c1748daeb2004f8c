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
 * Iterations of a block pass: velocities, displacement, splits, verification with rollback, merges
 * and cuts, other edits, deletion of degenerate components. Close pairs of vertices and small
 * components are kept between iterations. Before and after each call the surface is closed,
 * oriented, manifold and, under the bound below, free of intersections. Idle threads help with
 * forces, shapes and proximity. Blocks that do not touch this one may have passes at the same time.
 *
 * Reasons for the absence of intersections, by operation:
 * - Splits do not move the surface, except for rounding below SizingField::Contact. They come first
 *   and last, so no edge is longer than eq. (1) allows in a search.
 * - Collapses, flips, removals, moves, merges and cuts: SurfaceEditor tests each new face against
 * all faces within reach (NewFacesIntersect) before the edit.
 * - Displacements: Proximity tests faces within reach with opposed normals, and stars that may be
 *   folded. At first contact, a plane separates the two parts, so their normals are opposed. Normal
 *   cones are compared with a margin of 30 degrees (SurfaceState::AreOpposed) for the rotation of
 *   normals until the end of the displacement, at most half a delta. Intersecting stars are rolled
 *   back, with growing surroundings, in the last round all vertices. This restores the valid mesh.
 * - Deletions remove whole components.
 * Divisions are tested like displacements. Tests are conservative (TrianglesIntersect). The bound
 * of 30 degrees is an observation. Therefore all faces are tested against each other, whatever
 * their normals are, in each initial surface, snapshot and result (CountIntersecting).
 */
class SurfaceIteration
{
public:
  /** Motion: by forces, or by Dynamics::Relax() with its three options. */
  enum class Mode
  {
    Evolve,
    Descend,
    Regularise,
    Adapt
  };

  /**
   * Move the vertices of a block pass, whose shapes must be up to date. All other vertices are
   * fixed. Small components within the region of the pass are watched.
   * @param evidence, topologyChanges see Remesher
   */
  SurfaceIteration(SurfaceState& state, BlockPass& pass, const Field* evidence,
    bool topologyChanges, Executor& threads = OnThisThread());
  ~SurfaceIteration();
  SurfaceIteration(const SurfaceIteration&) = delete;
  SurfaceIteration& operator=(const SurfaceIteration&) = delete;

  /** Run an iteration. @return its row; Vertices and EulerCharacteristic are differences */
  HistoryRow Run(const Dynamics& dynamics, Mode mode);

  /** Return the active vertices of the last iteration. */
  const std::vector<int>& ActiveVertices() const { return this->Active; }

  /** After edits: update the shapes of vertices, and mark their stars for new tests. */
  static void UpdateChanged(SurfaceState& state, std::vector<int> changed);

private:
  /** Displace the active vertices, test for intersections, and roll back. */
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
  BlockPass& Pass;
  Executor& Threads;
  Remesher Edits;
  Proximity Near;    ///< of all vertices; keeps the pairs
  Proximity Recheck; ///< of vertices that were rolled back
  ComponentWatch Watch;
  Dynamics::Step Step;
  std::vector<int> Active;
  std::vector<int> Working;       ///< see CollectWorking(); marked with IsWorking
  std::vector<int> DirtyVertices; ///< see CollectDirtyVertices()
  EditCounts Labelled;            ///< counters of the edit context at the last labelling
};
}

#endif

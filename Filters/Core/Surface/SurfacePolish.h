// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfacePolish_h
#define volumicSurfacePolish_h

#include "Core/Common/Monitor.h"
#include "Core/Image/Field.h"
#include "Core/Surface/EditCells.h"

#include <utility>
#include <vector>

namespace volumic
{
/**
 * The last touch at the end of a level: looks at the few vertices whose stars hold an edge outside
 * the bounds of eq. (1) or an ill-shaped face, which smoothing as a whole leaves behind, and tries
 * what would make the worst of each star better: removing a vertex of valence 3, a collapse, a
 * flip, or a slide along the surface. Before and after, vertices that are nearer than lambda delta
 * though far apart on the surface are pushed apart. The topology stays as it is, but for cuts
 * along 3-cycles where nothing else mends an edge that is too short.
 *
 * Every edit is one of SurfaceEditor's, verified, so the mesh stays manifold and free of
 * intersections; one is made only where the worst of the faces concerned gets better, so it ends.
 * What is tried at a star: StarImprovement. Edits are made by passes of EditCells: the same for any
 * executor.
 */
class SurfacePolish
{
public:
  /** `snapTo` (may be null): vertices that slide are led back onto its isopotential. */
  SurfacePolish(SurfaceState& state, const Field* snapTo, bool topologyChanges, Executor& executor,
    Checkpoint goOn = NeverStop)
    : State(state)
    , Cells(state, executor)
    , Threads(executor)
    , SnapTo(snapTo)
    , TopologyChanges(topologyChanges)
    , Goes(std::move(goOn))
  {
  }

  /** Stops after an edit, if asked to. Normals must be up to date. */
  void Run();
  /** The same for the stars of a list, those of an open block (SurfaceBlocks). */
  void Run(const std::vector<int>& vertices);

  /** Changed vertices of all its edits, in order; some may be named often. */
  std::vector<int> TakeChanged() { return this->Cells.TakeChanged(); }

private:
  std::vector<int> AliveOnes() const; ///< Of all, or of the list and what is new.
  void SeparateAll();
  void ImproveAll(float good); ///< Those of the stars whose worst scores less than `good`.
  bool IsToStop();             ///< Asked now and then.

  SurfaceState& State;
  EditCells Cells;
  Executor& Threads;
  const std::vector<int>* Within = nullptr; ///< Whose stars are looked at; null: all.
  const Field* SnapTo;
  bool TopologyChanges;
  Checkpoint Goes;
  double Done = 0.; ///< Share of the work.
  bool Stopped = false;
  bool MayCut = false;
};
}

#endif

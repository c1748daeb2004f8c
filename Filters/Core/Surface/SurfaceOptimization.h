// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceOptimization_h
#define volumicSurfaceOptimization_h

#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceEditor.h"

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
 * What is tried at a star: StarImprovement.
 */
class SurfaceOptimization
{
public:
  /**
   * @param snapTo (may be null): vertices that slide are led back onto its isopotential
   * @param share of the visit; null: nobody else edits
   */
  SurfaceOptimization(
    SurfaceState& state, const Field* snapTo, bool topologyChanges, EditContext* share = nullptr)
    : State(state), Share(share), Editor(state, share), SnapTo(snapTo),
      TopologyChanges(topologyChanges)
  {
  }

  /** Of the stars of a list, in order, and of those that cuts make. Normals must be up to date. */
  void Run(const std::vector<int>& vertices);

  /** Changed vertices of all its edits, in order; some may be named often. */
  std::vector<int> TakeChanged() { return this->Editor.TakeChanged(); }

private:
  int EndOfNew() const;               ///< What is made next gets this index.
  std::vector<int> AliveOnes() const; ///< Of the list, and what cuts have made.
  void SeparateAll();
  /** Those of the stars whose worst scores less than `good`. @return the cuts made */
  int ImproveAll(float good, bool mayCut);

  SurfaceState& State;
  const EditContext* Share;
  SurfaceEditor Editor;
  int FirstNew = 0;        ///< What is made after Run() has begun follows it.
  std::vector<int> Within; ///< Whose stars may be poor.
  const Field* SnapTo;
  bool TopologyChanges;
};
}

#endif

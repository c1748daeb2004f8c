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
 * Final optimization of a level. It improves the few stars that smoothing leaves with an edge
 * outside the bounds of eq. (1) or an ill-shaped face, with the edits of StarImprovement. Before
 * and after, vertices nearer than lambda delta but far apart on the surface are pushed apart. The
 * topology is unchanged, except for cuts along 3-cycles that block the collapse of an edge that is
 * too short.
 *
 * SurfaceEditor verifies every edit, so the mesh stays manifold and free of intersections. An edit
 * is made only if the worst score of the faces concerned increases, so the optimization terminates.
 */
class SurfaceOptimization
{
public:
  /**
   * @param snapTo field whose isosurface sliding vertices are projected onto; may be null
   * @param context of the block pass; null: no other thread edits
   */
  SurfaceOptimization(
    SurfaceState& state, const Field* snapTo, bool topologyChanges, EditContext* context = nullptr)
    : State(state), Context(context), Editor(state, context), SnapTo(snapTo),
      TopologyChanges(topologyChanges)
  {
  }

  /** Optimize the listed stars, in order, and those that cuts make. Normals must be up to date. */
  void Run(const std::vector<int>& vertices);

  /** Return the changed vertices of all edits, in order, with duplicates. */
  std::vector<int> TakeChanged() { return this->Editor.TakeChanged(); }

private:
  int NextVertex() const;                 ///< Index of the next new vertex.
  std::vector<int> AliveVertices() const; ///< Of Candidates and those made by cuts.
  void SeparateAll();
  /** Improve stars whose score is less than `good`. Return the number of cuts. */
  int ImproveAll(float good, bool mayCut);

  SurfaceState& State;
  const EditContext* Context;
  SurfaceEditor Editor;
  int FirstNew = 0;            ///< First vertex made by Run().
  std::vector<int> Candidates; ///< Vertices whose stars may be poor.
  const Field* SnapTo;
  bool TopologyChanges;
};
}

#endif

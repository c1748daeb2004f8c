// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarImprovement_h
#define volumicStarImprovement_h

#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceEditor.h"

#include <vector>

namespace volumic
{
/** Stars with at least this StarScore are not edited. */
constexpr float GoodStar = 0.82f;
/** Stars below this score may slide off the isosurface, and may lose a short edge. */
constexpr float BadStar = 0.55f;

/**
 * Edits of one star whose worst face or edge is bad: removal of a vertex of valence 3, collapse,
 * flip, or slide along the surface. A vertex too near to another part of the surface is moved away.
 * An edit is made only if the worst score of the faces concerned increases.
 */
class StarImprovement
{
public:
  /**
   * @param snapTo field whose isosurface sliding vertices are projected onto; may be null
   * @param mayCut cut along a 3-cycle if no other edit removes an edge that is too short
   */
  StarImprovement(SurfaceState& state, SurfaceEditor& editor, const Field* snapTo, bool mayCut)
    : State(state), Editor(editor), SnapTo(snapTo), MayCut(mayCut)
  {
  }

  /** Improve the star of an alive vertex. Return whether an edit was made. */
  bool Improve(int v);
  bool Separate(int v);

private:
  Vector Snapped(int v, const Vector& position) const;
  bool CollapseEdges(int v);
  bool CollapseEdge(int u, int v, float before);
  bool FlipEdges(int v);
  bool LeavesIsosurface(int v, const Vector& position) const;
  bool Approaches(int v, const Vector& position) const;
  bool Slide(int v);

  struct Candidate
  {
    float Score;
    Vector Position;
  };

  SurfaceState& State;
  SurfaceEditor& Editor;
  const Field* SnapTo;
  bool MayCut;
  std::vector<Candidate> Candidates;
};

/** Return the push away from vertices that violate the clearance lambda delta of eq. (1). */
Vector PushAt(const SurfaceState& state, int v);
}

#endif

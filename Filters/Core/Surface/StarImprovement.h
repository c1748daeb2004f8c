// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarImprovement_h
#define volumicStarImprovement_h

#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceEditor.h"

#include <vector>

namespace volumic
{
/** Stars that score this much, see StarScore, are left as they are. */
constexpr float GoodStar = 0.82f;
/** Stars that score less are worth a slide off the isopotential, and the loss of a short edge. */
constexpr float BadStar = 0.55f;

/**
 * What can be done for one star whose worst face or edge is bad: removing a vertex of valence 3, a
 * collapse, a flip, or a slide along the surface; and for one that is too near to what is far apart
 * on the surface: a step away from it. An edit is made only where the worst of the faces concerned
 * gets better.
 */
class StarImprovement
{
public:
  /**
   * @param snapTo (may be null): vertices that slide are led back onto its isopotential
   * @param mayCut along a 3-cycle, where nothing else mends an edge that is too short
   */
  StarImprovement(SurfaceState& state, SurfaceEditor& editor, const Field* snapTo, bool mayCut)
    : State(state)
    , Editor(editor)
    , SnapTo(snapTo)
    , MayCut(mayCut)
  {
  }

  /** Mends the star; the vertex must be alive. @return whether an edit was made */
  bool Improve(int v);
  bool Separate(int v);

private:
  Vector Snapped(int v, const Vector& position) const;
  bool CollapseEdges(int v);
  bool CollapseEdge(int u, int v, float before);
  bool FlipEdges(int v);
  bool Strays(int v, const Vector& position) const;
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

/** A push away from vertices that are nearer than lambda delta though far apart on the surface. */
Vector PushAt(const SurfaceState& state, int v);
}

#endif

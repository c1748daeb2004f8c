// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEditor_h
#define volumicSurfaceEditor_h

#include "Core/Surface/Proximity.h"
#include "Core/Surface/SurfaceState.h"

#include <vector>

namespace volumic
{
/**
 * Verified edits of the live surface: each checks the mesh (manifold), the constraints (lengths,
 * normals that turn little) and, near anything that is not smooth surface, that no triangle will
 * intersect; only then it edits and keeps grid, arrays, chi and counts in step.
 * All return whether they have done it. Sequential, in the order called.
 */
class SurfaceEditor
{
public:
  explicit SurfaceEditor(SurfaceState& state)
    : State(state)
  {
  }

  /** How much the faces about an edit may turn: least cosine between old and new normals. */
  enum class Care
  {
    Smooth,  ///< Regular remeshing.
    Rough    ///< Un-sticking: any new face that is verified and not inverted.
  };

  /** At the midpoint; always possible unless a valence is at its limit. @return vertex or -1. */
  int Split(int u, int v);
  /** Into the midpoint, else either end. */
  bool Collapse(int u, int v, Care care);
  /** Into a given position. */
  bool CollapseTo(int u, int v, const Vector& position, Care care);
  /** Flip for a better shape: nearly flat, new edge legal. */
  bool FlipForShape(int u, int v);
  /** Flip that joins two vertices nearer than the constraint allows to strangers. */
  bool FlipForConstraint(int u, int v);
  /** A vertex of valence 3. */
  bool Remove(int v);
  /** Moves a vertex; Smooth: the faces about it turn little. */
  bool Move(int v, const Vector& position, Care care);
  /** Merge of two stars. */
  bool Merge(int u, int v);
  /** Cut along u, v, w; both sides are drawn apart. */
  bool Cut(int u, int v, int w);

private:
  bool FacesAreSound(const Vector& old, float leastCosine) const;
  bool CollapseInto(int kept, int removed, const Vector& position, Care care);
  bool NearAnything(int u) const;

  SurfaceState& State;
  std::vector<MeshTriangle> Faces;
};
}

#endif

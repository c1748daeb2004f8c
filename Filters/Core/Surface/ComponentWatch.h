// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentWatch_h
#define volumicComponentWatch_h

#include "Core/Common/Box.h"
#include "Core/Surface/ConnectedVertices.h"
#include "Core/Surface/SurfaceEditor.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Keeps the labels of the components and watches the small ones: those that have shrunk to
 * nothing, that lie wholly on the side where they must vanish, or whose signed volume has changed
 * sign in a step are deleted (Documentation/differences.md, Changes of topology).
 */
class ComponentWatch
{
public:
  /** Components up to this many vertices are watched. */
  static constexpr int SmallSize = 400;

  /** Labels components afresh, by their smallest vertex. Call after merges and cuts. */
  void Label(SurfaceState& state, Executor& executor);

  /**
   * The same for a part of the surface: the small components that have a vertex in a list, or grow
   * to it from there, and lie in a box get labels of their own and are watched; the others are left
   * as they are.
   */
  void LabelSmall(SurfaceState& state, const std::vector<int>& vertices, const Box& within);

  /**
   * Deletes those of the small components that must go; every vertex must have its label.
   * @param share of the visit, which keeps the books; null: the state does
   * @return whether anything was deleted.
   */
  bool DeleteDegenerate(SurfaceState& state, EditShare* share = nullptr);

  /**
   * Deletes components that are inside out: a cavity must lie inside the others, any other one
   * outside. Such a one may be born by a cut, of no size and without any intersection, and would
   * grow without limit. They are judged from outside in, as if what is deleted had never been: what
   * lies in one that is inside out need not be. Rays along x: O(n + pairs of ray and triangle that
   * overlap).
   * @return whether anything was deleted (labels are fresh then).
   */
  bool DeleteInsideOut(SurfaceState& state, Executor& executor);

  int NumberOfComponents() const { return this->Components; }
  /** Of a surface in parts, that others have counted. */
  void TakeNumber(int components) { this->Components = components; }

private:
  struct SmallComponent
  {
    int Label = 0;
    std::vector<int> Vertices; ///< When last seen; empty once it has grown or is deleted.
    bool IsPositive = true;    ///< Of the volume, when it was labelled.
  };

  void WatchSmallOnes(
    const SurfaceState& state, const std::vector<int>& sizes, Executor& executor);
  /** Whether a component is a small one; if so, its vertices are in Stack. Marks what it sees. */
  bool IsSmall(SurfaceState& state, int v, const Box& within);
  /** Finds the vertices that the component has now, in Stack. @return false if it has none. */
  bool FindVertices(SurfaceState& state, const SmallComponent& small);

  std::vector<SmallComponent> Watched;
  std::vector<int> Stack;
  std::vector<int> AllSeen;
  ConnectedVertices Connected; ///< As last labelled.
  int Components = 0;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentWatch_h
#define volumicComponentWatch_h

#include "Core/Surface/SurfaceState.h"

#include <utility>
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
  /** Labels components afresh, by their smallest vertex. Call after merges and cuts. */
  void Label(SurfaceState& state, Executor& executor);

  /** Deletes what must go; labels must be fresh. @return whether anything was deleted. */
  bool DeleteDoomed(SurfaceState& state);

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

private:
  struct Small
  {
    int Label = 0;
    std::vector<int> Vertices;
    bool Positive = true; ///< Sign of the volume.
  };
  std::vector<Small> Smalls;
  std::vector<int> Stack;
  std::vector<int> Sizes;
  std::vector<int> Roots;
  std::vector<std::vector<std::pair<int, int>>> Borders;
  int Components = 0;
};

/** Six times the signed volume of the faces about the vertices, each face counted three times. */
double SignedVolume(const SurfaceMesh& mesh, const std::vector<int>& vertices);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarReach_h
#define volumicStarReach_h

#include "Core/Surface/SurfaceState.h"

#include <algorithm>

namespace volumic
{
/**
 * How far a vertex is looked about for others. Where a surface is graded that is further than where
 * all are alike, as others may be larger: but faces that intersect have corners that are as near as
 * the largest delta of all their corners makes it, so most pairs need no look.
 */
class StarReach
{
public:
  StarReach(const SurfaceState& state, int v)
    : State(state), Most(state.Sizing.Reach(v)),
      Own(state.Sizing.IsGraded() ? this->Of(v) : this->Most)
  {
  }
  /** The reach of the pair with w, at this distance. */
  float With(int w, float squared) const
  {
    const bool isNear = squared <= this->Own * this->Own;
    const bool isFar = squared > this->Most * this->Most;
    return isNear || isFar ? this->Most : std::min(this->Most, std::max(this->Own, this->Of(w)));
  }

private:
  /** What the largest delta of a star asks for. */
  float Of(int v) const
  {
    const Ring& ring = this->State.Mesh.Rings[v];
    float largest = this->State.Sizing.At(v);
    for (int i = 0; i < ring.Count; ++i)
    {
      largest = std::max(largest, this->State.Sizing.At(ring.Item[i]));
    }
    return SizingField::ReachInDelta * largest;
  }

  const SurfaceState& State;
  float Most;
  float Own;
};
}

#endif

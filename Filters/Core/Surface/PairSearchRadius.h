// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPairSearchRadius_h
#define volumicPairSearchRadius_h

#include "Core/Surface/SurfaceState.h"

#include <algorithm>

namespace volumic
{
/**
 * Search radius about a vertex. On a graded surface it exceeds that of a uniform one, as
 * neighbouring faces may be larger. Intersecting faces have corners within the radius for the
 * largest delta of all their corners, so most pairs can be skipped.
 */
class PairSearchRadius
{
public:
  PairSearchRadius(const SurfaceState& state, int v)
    : State(state), Most(state.Sizing.SearchRadius(v)),
      Own(state.Sizing.IsGraded() ? this->OfStar(v) : this->Most)
  {
  }
  /** Return the search radius of the pair with w at this distance. */
  float With(int w, float squared) const
  {
    const bool isNear = squared <= this->Own * this->Own;
    const bool isFar = squared > this->Most * this->Most;
    return isNear || isFar ? this->Most
                           : std::min(this->Most, std::max(this->Own, this->OfStar(w)));
  }

private:
  /** Return the search radius for the largest delta of a star. */
  float OfStar(int v) const
  {
    const Ring& ring = this->State.Mesh.Rings[v];
    float largest = this->State.Sizing.At(v);
    for (int i = 0; i < ring.Count; ++i)
    {
      largest = std::max(largest, this->State.Sizing.At(ring.Item[i]));
    }
    return SizingField::SearchRadiusInDelta * largest;
  }

  const SurfaceState& State;
  float Most;
  float Own;
};
}

#endif

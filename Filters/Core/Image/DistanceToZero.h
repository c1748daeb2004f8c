// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDistanceToZero_h
#define volumicDistanceToZero_h

#include "Core/Common/Vector.h"

namespace volumic
{
/**
 * Return the distance to the nearest zero of a field along a normal, in both directions, negative
 * inside the object. The search has 20 steps up to `furthest`, which is returned if there is no
 * zero.
 *
 * @param value   field at the position
 * @param valueAt returns the field at another position
 */
template <typename ValueAt>
float SignedDistanceToZero(
  const Vector& position, const Vector& normal, float value, float furthest, const ValueAt& valueAt)
{
  constexpr float steps = 20.f;
  const float step = furthest / steps;
  const float sign = value > 0 ? -1.f : 1.f;
  float before[2] = { value, value };
  for (float distance = step; distance < furthest; distance += step)
  {
    for (int side = 0; side < 2; ++side)
    {
      const float there = valueAt(position + normal * (side == 0 ? distance : -distance));
      if ((there > 0) != (value > 0))
      {
        return sign * (distance - step * there / (there - before[side]));
      }
      before[side] = there;
    }
  }
  return sign * furthest;
}
}

#endif

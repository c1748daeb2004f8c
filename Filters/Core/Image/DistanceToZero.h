// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDistanceToZero_h
#define volumicDistanceToZero_h

#include "Core/Common/Vector.h"

namespace volumic
{
/**
 * How far a field's next zero is from a place along a normal, either way, in steps of a twentieth
 * of the furthest that is looked; negative where the field is positive, which is behind the zero.
 *
 * @param value   of the field at the place
 * @param valueAt of it at another place
 */
template <typename ValueAt>
float SignedDistanceToZero(
  const Vector& place, const Vector& normal, float value, float furthest, const ValueAt& valueAt)
{
  constexpr float steps = 20.f;
  const float step = furthest / steps;
  const float sign = value > 0 ? -1.f : 1.f;
  float before[2] = { value, value };
  for (float way = step; way < furthest; way += step)
  {
    for (int side = 0; side < 2; ++side)
    {
      const float there = valueAt(place + normal * (side == 0 ? way : -way));
      if ((there > 0) != (value > 0))
      {
        return sign * (way - step * there / (there - before[side]));
      }
      before[side] = there;
    }
  }
  return sign * furthest;
}
}

#endif

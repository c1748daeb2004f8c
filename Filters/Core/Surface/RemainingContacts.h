// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRemainingContacts_h
#define volumicRemainingContacts_h

#include "Core/Common/Executor.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The places where the object, or a gap in it, is thinner than the mesh can hold, and the image
 * does not want it cut or merged.
 */
struct RemainingContacts
{
  /**
   * The pairs that eq. (1) forbids and that are there nevertheless: nearer than lambda delta
   * (2.5/sqrt 3 delta) though not near along the surface, that is, at least four edges apart or on
   * different components (Documentation/differences.md, Constraints: what is nearer along the
   * surface is only bent). Mesh indices (v, w), v < w, sorted.
   */
  LargeVector<std::array<int, 2>> Pairs;
  /**
   * Per vertex, 1 where eq. (1) holds it off its place: a vertex of the opposite normal is less
   * than 1.15 lambda delta away, and the isopotential is more than 0.1 delta away.
   */
  LargeVector<std::uint8_t> Held;
};

/**
 * The grid of the state must be up to date. The same for any executor. Cost: O(vertices).
 */
RemainingContacts FindRemainingContacts(
  const SurfaceState& state, const Field& field, Executor& executor);
}

#endif

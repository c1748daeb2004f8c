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
 * Regions where the object, or a gap in it, is thinner than the mesh can represent, and where the
 * image requires neither a cut nor a merge.
 */
struct RemainingContacts
{
  /**
   * Pairs that violate the clearance of eq. (1): nearer than lambda delta (2.5/sqrt 3 delta), but
   * at least four edges apart or on different components. See Documentation/differences.md,
   * Constraints. Mesh indices (v, w), v < w, sorted.
   */
  LargeVector<std::array<int, 2>> Pairs;
  /**
   * Per vertex: 1 if eq. (1) keeps it away from the isosurface. A vertex of opposite normal is then
   * less than 1.15 lambda delta away, and the isosurface more than 0.1 delta.
   */
  LargeVector<std::uint8_t> Held;
};

/**
 * Find the remaining contacts in O(vertices). The grid of the state must be up to date. The result
 * does not depend on the executor.
 */
RemainingContacts FindRemainingContacts(
  const SurfaceState& state, const Field& field, Executor& executor);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarIntersections_h
#define volumicStarIntersections_h

#include "Core/Surface/Proximity.h"
#include "Core/Surface/StarFaces.h"

namespace volumic
{
/** Clearance in delta that TestStars() requires at first, so that later tests can be skipped. */
constexpr float TestedClearance = 0.01f;

/** Return the larger clearance along two directions. The stars must not have a common vertex. */
float ClearanceBetween(const SurfaceState& state, const StarLink& first, const StarLink& second);

/** Append intersecting faces. Return the certain clearance of the others. */
float TestStars(const SurfaceState& state, const StarFaces& first, const StarFaces& second,
  Proximity::Findings& found);
}

#endif

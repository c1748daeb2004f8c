// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarScore_h
#define volumicStarScore_h

#include "Core/Surface/SurfaceState.h"

namespace volumic
{
/** Relative margin of the edge length bounds, for the rounding of world coordinates. */
constexpr float ScoreMargin = 1e-4f;

/** Return the radius ratio of a face, 2 inradius / circumradius: 0 to 1, or -1 if undefined. */
float FaceScore(const Vector& a, const Vector& b, const Vector& c);

/** Return 1 for a length that eq. (1) allows, else a negative value: worse than any face. */
float EdgeScore(const SizingField& sizing, int u, int v, float squaredLength);

/**
 * Return the worst score of the faces and edges of v at a position. Values up to `bound` may be
 * inexact, which saves time.
 */
float StarScore(const SurfaceState& state, int v, const Vector& position, float bound = -2.f);

/** Return the StarScore of the vertex to which the edge (u, v) collapses. */
float CollapseScore(
  const SurfaceState& state, int u, int v, const Vector& position, float bound = -2.f);
}

#endif

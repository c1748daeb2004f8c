// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarScore_h
#define volumicStarScore_h

#include "Core/Surface/SurfaceState.h"

namespace volumic
{
/**
 * Scores count edges as too short or too long a little before eq. (1) does, by this share, for the
 * rounding of the map to the world.
 */
constexpr float ScoreMargin = 1e-4f;

/** Radius ratio of a face, twice the inscribed over the circumscribed circle's: 0 to 1, -1: none */
float FaceScore(const Vector& a, const Vector& b, const Vector& c);

/** 1 for a length that eq. (1) allows, else negative: worse than any face. */
float EdgeScore(const SizingField& sizing, int u, int v, float squaredLength);

/**
 * The worst of the faces and edges about a vertex, if it were at the position. @param bound what
 * scores no more than this may be told as anything up to it, which takes less
 */
float StarScore(const SurfaceState& state, int v, const Vector& position, float bound = -2.f);

/** The worst of those about what an edge collapses to. @param bound as above */
float CollapseScore(
  const SurfaceState& state, int u, int v, const Vector& position, float bound = -2.f);
}

#endif

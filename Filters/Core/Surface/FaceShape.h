// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFaceShape_h
#define volumicFaceShape_h

#include "Core/Mesh/TriangleTests.h"

#include <algorithm>

namespace volumic
{
/** Normal of a face, twice its area long. */
inline VectorD AreaNormal(const MeshTriangle& t)
{
  return Cross(t.Corner[1] - t.Corner[0], t.Corner[2] - t.Corner[0]);
}

/** Height over longest edge: 0 for a sliver, .87 for an equilateral triangle. */
inline double AspectOf(const MeshTriangle& t)
{
  const double longest = std::max({ SquaredDistance(t.Corner[0], t.Corner[1]),
    SquaredDistance(t.Corner[1], t.Corner[2]), SquaredDistance(t.Corner[2], t.Corner[0]) });
  return longest > 0 ? Length(AreaNormal(t)) / longest : 0.;
}

/** The least aspect of a new face: eq. (1) alone allows slivers, whose normals say nothing. */
constexpr double LeastAspect = 0.06;

inline bool IsWellShaped(const MeshTriangle& t)
{
  return AspectOf(t) > LeastAspect;
}

/** Whether an edit may make `now` of a face: well-shaped, or what is not gets better. */
inline bool KeepsShape(const MeshTriangle& before, const MeshTriangle& now)
{
  constexpr double better = 1.01;
  return AspectOf(now) >= std::min(LeastAspect, better * AspectOf(before));
}

/** Whether a face turns less than a cosine allows. A sliver's normal is none, and may turn. */
inline bool TurnsLittle(const MeshTriangle& before, const MeshTriangle& now, double leastCosine)
{
  const VectorD normal = AreaNormal(now);
  const VectorD oldNormal = AreaNormal(before);
  return AspectOf(before) <= LeastAspect ||
    Dot(normal, oldNormal) >= leastCosine * Length(normal) * Length(oldNormal);
}
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFaceShape_h
#define volumicFaceShape_h

#include "Core/Mesh/TriangleTests.h"

#include <algorithm>

namespace volumic
{
/** Return the normal of a face, with twice its area as length. */
inline VectorD AreaNormal(const MeshTriangle& t)
{
  return Cross(t.Corner[1] - t.Corner[0], t.Corner[2] - t.Corner[0]);
}

/** Return height over longest edge: 0 for a sliver, 0.87 for an equilateral triangle. */
inline double AspectOf(const MeshTriangle& t)
{
  const double longest = std::max({ SquaredDistance(t.Corner[0], t.Corner[1]),
    SquaredDistance(t.Corner[1], t.Corner[2]), SquaredDistance(t.Corner[2], t.Corner[0]) });
  return longest > 0 ? Length(AreaNormal(t)) / longest : 0.;
}

/** Least aspect of a new face: eq. (1) alone allows slivers, whose normals are unreliable. */
constexpr double LeastAspect = 0.06;

/** Least cosine between two faces at an edge that are certainly not folded onto each other. */
constexpr float Unfolded = -0.99f;

inline bool IsWellShaped(const MeshTriangle& t)
{
  return AspectOf(t) > LeastAspect;
}

/** Return whether a changed face is well-shaped, or better shaped than before. */
inline bool KeepsShape(const MeshTriangle& before, const MeshTriangle& now)
{
  constexpr double better = 1.01;
  return AspectOf(now) >= std::min(LeastAspect, better * AspectOf(before));
}

/** Return whether a face turns by less than a cosine allows, or is a sliver (no valid normal). */
inline bool TurnsLittle(const MeshTriangle& before, const MeshTriangle& now, double leastCosine)
{
  const VectorD normal = AreaNormal(now);
  const VectorD oldNormal = AreaNormal(before);
  return AspectOf(before) <= LeastAspect ||
    Dot(normal, oldNormal) >= leastCosine * Length(normal) * Length(oldNormal);
}
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleShape_h
#define volumicTriangleShape_h

#include "Core/Common/Vector.h"
#include "Core/Mesh/TriangleTests.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
/** Return twice the inradius divided by the circumradius: 1 for an equilateral triangle. */
inline double RadiusRatio(const MeshTriangle& t)
{
  const VectorD& a = t.Corner[0];
  const VectorD& b = t.Corner[1];
  const VectorD& c = t.Corner[2];
  const double ab = Length(b - a);
  const double bc = Length(c - b);
  const double ca = Length(a - c);
  const double product = ab * bc * ca * (ab + bc + ca);
  return product > 0. ? 4. * SquaredLength(Cross(b - a, c - a)) / product : 0.;
}

/** Triangles with a smaller angle are slivers, in radians. */
constexpr double SliverAngle = 0.5;

/** Return the smallest angle, which is opposite to the shortest edge, in radians. */
inline double SmallestAngle(const MeshTriangle& t)
{
  const VectorD& a = t.Corner[0];
  const VectorD& b = t.Corner[1];
  const VectorD& c = t.Corner[2];
  const double ab = SquaredDistance(a, b);
  const double bc = SquaredDistance(b, c);
  const double ca = SquaredDistance(c, a);
  const VectorD& at = ab <= bc && ab <= ca ? c : bc <= ca ? a : b;
  const VectorD first = (&at == &a ? b : a) - at;
  const VectorD second = (&at == &c ? b : c) - at;
  return std::atan2(Length(Cross(first, second)), Dot(first, second));
}

inline VectorD NormalOf(const MeshTriangle& t)
{
  return Cross(t.Corner[1] - t.Corner[0], t.Corner[2] - t.Corner[0]);
}

inline double CosineOf(const VectorD& a, const VectorD& b)
{
  const double lengths = Length(a) * Length(b);
  return lengths > 0. ? Dot(a, b) / lengths : 0.;
}
}

#endif

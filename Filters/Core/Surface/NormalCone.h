// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicNormalCone_h
#define volumicNormalCone_h

#include "Core/Common/Lanes.h"
#include "Core/Common/Vector.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
/** Smallest cone about a vertex normal that contains the normals of its faces. */
struct alignas(16) NormalCone
{
  float X = 0; ///< Axis: the unit vertex normal, or 0 if undefined.
  float Y = 0;
  float Z = 0;
  float Cosine = 0; ///< Cosine of the largest angle between the axis and a face normal.

  NormalCone() = default;
  NormalCone(const Vector& axis, float cosine) : X(axis.X), Y(axis.Y), Z(axis.Z), Cosine(cosine) {}

  Vector Axis() const { return Vector(this->X, this->Y, this->Z); }
};

/** Return whether two normals, one of each cone, may differ by more than 150 degrees. */
inline bool AreOpposed(const NormalCone& n, const NormalCone& m)
{
  constexpr float cosine150 = -0.8660254f;
  constexpr float sine150 = 0.5f;
  const float cv = n.Cosine;
  const float cw = m.Cosine;
  const float sv = std::sqrt(std::max(0.f, 1 - cv * cv));
  const float sw = std::sqrt(std::max(0.f, 1 - cw * cw));
  const float cosine = cv * cw - sv * sw; // Of the sum of both half-angles.
  const float sine = sv * cw + cv * sw;
  // Opposed if the angle between the axes plus both half-angles exceeds 150 degrees.
  if (cosine < cosine150 || cv < 0 || cw < 0)
  {
    return true;
  }
  return n.X * m.X + n.Y * m.Y + n.Z * m.Z < cosine150 * cosine + sine150 * sine;
}

/** Compare one cone with four others. Return one bit for each. */
inline unsigned OpposedBits(const NormalCone& n, const NormalCone& a, const NormalCone& b,
  const NormalCone& c, const NormalCone& d)
{
  constexpr float cosine150 = -0.8660254f;
  constexpr float sine150 = 0.5f;
  const Lanes cv(n.Cosine);
  const Lanes sv(std::sqrt(std::max(0.f, 1 - n.Cosine * n.Cosine)));
  Lanes cw;
  const VectorLanes axis = Gather(&a.X, &b.X, &c.X, &d.X, cw);
  const Lanes zero(0.f);
  const Lanes sw = SquareRoot(Maximum(zero, Lanes(1.f) - cw * cw));
  const Lanes cosine = cv * cw - sv * sw;
  const Lanes sine = sv * cw + cv * sw;
  return LessBits(cosine, Lanes(cosine150)) | LessBits(Minimum(cv, cw), zero) |
    LessBits(Dot(AllLanes(n.Axis()), axis), Lanes(cosine150) * cosine + Lanes(sine150) * sine);
}
}

#endif

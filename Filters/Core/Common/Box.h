// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBox_h
#define volumicBox_h

#include "Core/Common/Vector.h"

#include <algorithm>

namespace volumic
{
inline Vector Minimum(const Vector& a, const Vector& b)
{
  return Vector(std::min(a.X, b.X), std::min(a.Y, b.Y), std::min(a.Z, b.Z));
}
inline Vector Maximum(const Vector& a, const Vector& b)
{
  return Vector(std::max(a.X, b.X), std::max(a.Y, b.Y), std::max(a.Z, b.Z));
}

/** A box along the axes. */
struct Box
{
  Vector Low;
  Vector High;

  /** The smallest box about three points. */
  static Box Of(const Vector& a, const Vector& b, const Vector& c)
  {
    return { Minimum(a, Minimum(b, c)), Maximum(a, Maximum(b, c)) };
  }

  /** The box made larger by a margin on all sides. */
  Box Grown(float margin) const
  {
    const Vector by(margin, margin, margin);
    return { this->Low - by, this->High + by };
  }
  /** The smallest box that holds another one, too. */
  Box With(const Box& other) const
  {
    return { Minimum(this->Low, other.Low), Maximum(this->High, other.High) };
  }
  /** What lies in both: a box with Low beyond High where they are apart. */
  Box Within(const Box& other) const
  {
    return { Maximum(this->Low, other.Low), Minimum(this->High, other.High) };
  }

  bool Contains(const Vector& p) const
  {
    return p.X >= this->Low.X && p.X <= this->High.X && p.Y >= this->Low.Y &&
      p.Y <= this->High.Y && p.Z >= this->Low.Z && p.Z <= this->High.Z;
  }
  bool IsApartFrom(const Box& b) const
  {
    return this->Low.X > b.High.X || b.Low.X > this->High.X || this->Low.Y > b.High.Y ||
      b.Low.Y > this->High.Y || this->Low.Z > b.High.Z || b.Low.Z > this->High.Z;
  }
};
}

#endif

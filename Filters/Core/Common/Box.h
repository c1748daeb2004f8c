// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBox_h
#define volumicBox_h

#include "Core/Common/Lanes.h"

namespace volumic
{
inline Vector Minimum(const Vector& a, const Vector& b)
{
  Vector least;
  Minimum(Lanes::Load(&a.X), Lanes::Load(&b.X)).Store(&least.X);
  return least;
}
inline Vector Maximum(const Vector& a, const Vector& b)
{
  Vector greatest;
  Maximum(Lanes::Load(&a.X), Lanes::Load(&b.X)).Store(&greatest.X);
  return greatest;
}
/** Return a bit for each axis: set if the coordinate of a is less. */
inline unsigned LessBits(const Vector& a, const Vector& b)
{
  return LessBits(Lanes::Load(&a.X), Lanes::Load(&b.X)) & 7u;
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
  Vector Middle() const { return (this->Low + this->High) * 0.5f; }
  /** What lies in both: a box with Low beyond High where they are apart. */
  Box Within(const Box& other) const
  {
    return { Maximum(this->Low, other.Low), Minimum(this->High, other.High) };
  }

  bool Contains(const Vector& p) const
  {
    return (LessBits(p, this->Low) | LessBits(this->High, p)) == 0;
  }
  bool IsApartFrom(const Box& b) const
  {
    return (LessBits(b.High, this->Low) | LessBits(this->High, b.Low)) != 0;
  }
};
}

#endif

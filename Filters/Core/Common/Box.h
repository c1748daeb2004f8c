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
/** Return bit k set if coordinate k of a is less than that of b. */
inline unsigned LessBits(const Vector& a, const Vector& b)
{
  return LessBits(Lanes::Load(&a.X), Lanes::Load(&b.X)) & 7u;
}

/** Axis-aligned box. */
struct Box
{
  Vector Low;
  Vector High;

  /** Return the bounding box of three points. */
  static Box Of(const Vector& a, const Vector& b, const Vector& c)
  {
    return { Minimum(a, Minimum(b, c)), Maximum(a, Maximum(b, c)) };
  }

  /** Return the box extended by a margin on all sides. */
  Box Grown(float margin) const
  {
    const Vector by(margin, margin, margin);
    return { this->Low - by, this->High + by };
  }
  /** Return the bounding box of both boxes. */
  Box With(const Box& other) const
  {
    return { Minimum(this->Low, other.Low), Maximum(this->High, other.High) };
  }
  Vector Middle() const { return (this->Low + this->High) * 0.5f; }
  /** Return the intersection; Low exceeds High if the boxes are disjoint. */
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

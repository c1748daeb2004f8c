// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicObliqueRotation_h
#define volumicObliqueRotation_h

#include "Core/Common/IndexedSurface.h"

#include <array>

namespace volumic
{
/**
 * Rotation that aligns no axis or diagonal with those of the given space. Otherwise lines along x
 * would lie in faces and pass through corners of axis-aligned shapes.
 */
class ObliqueRotation
{
public:
  static constexpr int Count = 5;

  /** Select a rotation: `number` modulo Count. */
  explicit ObliqueRotation(int number)
  {
    // Irregular quaternions, not normalised.
    static constexpr double quaternions[Count][4] = { { 0.83, 0.31, 0.37, 0.29 },
      { 0.71, -0.43, 0.29, 0.48 }, { 0.57, 0.23, -0.61, 0.49 }, { 0.91, 0.17, -0.22, 0.33 },
      { 0.42, -0.51, 0.64, 0.38 } };
    const double* q = quaternions[number % Count];
    const double w = q[0];
    const double x = q[1];
    const double y = q[2];
    const double z = q[3];
    const double n = w * w + x * x + y * y + z * z;
    this->Rows = {
      { { (w * w + x * x - y * y - z * z) / n, 2. * (x * y - w * z) / n, 2. * (x * z + w * y) / n },
        { 2. * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2. * (y * z - w * x) / n },
        { 2. * (x * z - w * y) / n, 2. * (y * z + w * x) / n,
          (w * w - x * x - y * y + z * z) / n } }
    };
  }

  Point Apply(const Point& p) const
  {
    Point q;
    for (int k = 0; k < 3; ++k)
    {
      q[k] = this->Rows[k][0] * p[0] + this->Rows[k][1] * p[1] + this->Rows[k][2] * p[2];
    }
    return q;
  }

  Point Undo(const Point& p) const
  {
    Point q;
    for (int k = 0; k < 3; ++k)
    {
      q[k] = this->Rows[0][k] * p[0] + this->Rows[1][k] * p[1] + this->Rows[2][k] * p[2];
    }
    return q;
  }

private:
  std::array<Point, 3> Rows;
};
}

#endif

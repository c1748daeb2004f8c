// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImageMargin_h
#define volumicImageMargin_h

#include "Core/Common/Vector.h"
#include "Core/Image/LevelImage.h"

#include <algorithm>
#include <limits>

namespace volumic
{
/**
 * Region around the image in which the surface may move. All forces from outside the image
 * (replicated border, edge map, gradient) fade between Width and Width + Ramp beyond the outermost
 * voxels. No displacement leads further out.
 *
 * A default-constructed margin is unbounded. Lengths are in the computational space.
 */
class ImageMargin
{
public:
  static constexpr double Width = 2.; ///< in units of the level; at least one voxel
  static constexpr double Ramp = 1.;  ///< in units of the level

  ImageMargin() = default;
  explicit ImageMargin(const LevelImage& image)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double width = std::max(Width * image.Unit, image.Step[k]);
      this->Low[k] = static_cast<float>(-width);
      this->High[k] = static_cast<float>((image.Size[k] - 1) * image.Step[k] + width);
    }
    this->RampLength = static_cast<float>(Ramp * image.Unit);
  }

  struct Depth
  {
    float Fraction = 0; ///< 0 up to Width, 1 from the end of the ramp on
    Vector Slope;       ///< gradient of Fraction
  };

  Depth DepthAt(const Vector& position) const
  {
    Depth depth;
    const float coordinate[3] = { position.X, position.Y, position.Z };
    float furthest = 0;
    for (int k = 0; k < 3; ++k)
    {
      const bool isLow = coordinate[k] < this->Low[k];
      const float out = isLow ? this->Low[k] - coordinate[k] : coordinate[k] - this->High[k];
      if (out > furthest)
      {
        furthest = out;
        const float slope = (isLow ? -1.f : 1.f) / this->RampLength;
        depth.Slope = Vector(k == 0 ? slope : 0.f, k == 1 ? slope : 0.f, k == 2 ? slope : 0.f);
      }
    }
    depth.Fraction = std::min(furthest / this->RampLength, 1.f);
    if (depth.Fraction >= 1.f)
    {
      depth.Slope = Vector();
    }
    return depth;
  }

  /**
   * Return the end of a displacement, clamped along each axis to the end of the ramp, or to its
   * start if that is further out.
   */
  Vector Confined(const Vector& from, const Vector& to) const
  {
    const auto within = [this](float a, float b, int k)
    {
      return std::max(std::min(b, std::max(a, this->High[k] + this->RampLength)),
        std::min(a, this->Low[k] - this->RampLength));
    };
    return Vector(within(from.X, to.X, 0), within(from.Y, to.Y, 1), within(from.Z, to.Z, 2));
  }

  /** Return whether Confined() would not change the displacement. */
  bool Allows(const Vector& from, const Vector& to) const
  {
    const Vector end = this->Confined(from, to);
    return end.X == to.X && end.Y == to.Y && end.Z == to.Z;
  }

private:
  static constexpr float Far = std::numeric_limits<float>::max() / 4;
  float Low[3] = { -Far, -Far, -Far };
  float High[3] = { Far, Far, Far };
  float RampLength = 1;
};
}

#endif

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
 * How far around the image the surface may go. Whatever drives it past the outermost voxels (a
 * replicated border, a map of edges, the gradient) fades between Width and Width + Ramp beyond
 * them, where all is background, and no displacement leads out any further.
 *
 * Made without an image it bounds nothing. Lengths: workspace.
 */
class ImageMargin
{
public:
  static constexpr double Width = 2.; ///< Units of the level; a voxel where that is longer.
  static constexpr double Ramp = 1.;  ///< Units of the level.

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
    float Share = 0; ///< 0 where nothing fades, 1 from the end of the ramp on.
    Vector Slope;    ///< Of Share, per unit of length.
  };

  Depth DepthAt(const Vector& position) const
  {
    Depth depth;
    const float place[3] = { position.X, position.Y, position.Z };
    float furthest = 0;
    for (int k = 0; k < 3; ++k)
    {
      const bool isLow = place[k] < this->Low[k];
      const float out = isLow ? this->Low[k] - place[k] : place[k] - this->High[k];
      if (out > furthest)
      {
        furthest = out;
        const float slope = (isLow ? -1.f : 1.f) / this->RampLength;
        depth.Slope = Vector(k == 0 ? slope : 0.f, k == 1 ? slope : 0.f, k == 2 ? slope : 0.f);
      }
    }
    depth.Share = std::min(furthest / this->RampLength, 1.f);
    if (depth.Share >= 1.f)
    {
      depth.Slope = Vector();
    }
    return depth;
  }

  /**
   * A way from one place to another, cut short along each axis so that it ends no further out than
   * the end of the ramp, or than where it began if that is beyond (as a start may be).
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

  /** Whether a way is as Confined would leave it. */
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

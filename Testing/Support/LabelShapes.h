// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelShapes_h
#define volumicLabelShapes_h

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

/** Label maps of analytic shapes. One world unit is the smallest voxel spacing. */
namespace volumic::support
{
/** The centre of voxel (i, j, k) is at spacing * (i, j, k). */
struct LabelMap
{
  std::array<int, 3> Size = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };
  std::vector<std::int16_t> Values; ///< x fastest
};

/** Analytic shape of a label. */
struct LabelShape
{
  int Label = 1;
  /** Implicit function, world units, negative inside. */
  std::function<double(const std::array<double, 3>&)> Distance;
  double Volume = 0.0; ///< world units cubed, within .02 %; 0 for shapes with sharp edges
};

enum class LabelShapeKind
{
  Sphere,
  Torus,         ///< tilted
  Gyroid,        ///< one side of a gyroid in a ball: high genus
  TouchingBalls, ///< labels 1 and 2, touching at a point
  CutBall        ///< labels 1 to 3: sectors of a ball; 4: a ball in their middle
};

struct DigitisedShapes
{
  LabelMap Map; ///< background: 0
  std::vector<LabelShape> Shapes;
};

/**
 * Digitise shapes at voxel centres. @param size voxels along x and y @param stretch spacing along z
 */
DigitisedShapes Digitise(LabelShapeKind kind, int size, double stretch = 1.0);

} // namespace volumic::support

#endif

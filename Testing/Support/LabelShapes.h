// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * Label maps of shapes that are known by formula, for surfaces of labels to be judged by what was
 * digitised. A unit of the world is the smallest distance of two voxels.
 */

#ifndef volumicLabelShapes_h
#define volumicLabelShapes_h

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace volumic::support
{

/** The centre of voxel (i, j, k) is at origin + spacing * (i, j, k). */
struct LabelMap
{
  std::array<int, 3> Size = { 0, 0, 0 };
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };
  std::array<double, 3> Origin = { 0.0, 0.0, 0.0 };
  std::vector<std::int16_t> Values; ///< x fastest
};

/** What a label is the digitisation of. */
struct LabelShape
{
  int Label = 1;
  /**
   * World units, negative inside: zero at the surface, and near it the distance to the first order
   * at least. Empty where the shape has sharp edges, which no surface is judged by.
   */
  std::function<double(const std::array<double, 3>&)> Distance;
  double Volume = 0.0; ///< world units cubed, within .02 %; 0 without Distance
};

enum class LabelShapeKind
{
  Sphere,
  Torus,         ///< tilted
  Gyroid,        ///< one sheet's inside within a ball, its rims rounded: of high genus
  TouchingBalls, ///< labels 1 and 2, which touch at a point
  CutBall        ///< labels 1 to 3: a ball cut in three like a cake; 4: a smooth ball in its middle
};

/** Letters only. */
std::string LabelShapeName(LabelShapeKind kind);

struct DigitisedShapes
{
  std::string Name; ///< LabelShapeName
  LabelMap Map;     ///< background: 0
  std::vector<LabelShape> Shapes;
};

/**
 * Voxels get the label whose shape their centres are in. `size`: voxels along x and y, at least 32;
 * along z as many as fill the same length, `stretch` units apart. Throws std::invalid_argument.
 */
DigitisedShapes Digitise(LabelShapeKind kind, int size, double stretch = 1.0);

} // namespace volumic::support

#endif

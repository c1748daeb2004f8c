// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInitialSurface_h
#define volumicInitialSurface_h

#include "Core/Image/Field.h"
#include "Core/Image/LevelImage.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** Return an icosahedron with its corners on a sphere, oriented outward. */
IndexedSurface Icosahedron(const Point& centre, double radius);

/** Return an icosahedron, subdivided on its sphere until the mean edge length is below `meanEdge`.
 */
IndexedSurface DividedIcosahedron(const Point& centre, double radius, double meanEdge);

/**
 * Return a rounded box around the image, with a margin of one voxel. Edges are 1.1 to 2 delta long
 * for any proportions of the image, legal by eq. (1).
 * @throws std::invalid_argument as CheckNumberOfVertices()
 */
IndexedSurface EnclosingSurface(const LevelImage& image, double delta);

/** Throw std::invalid_argument if a surface of this area would have too many vertices. */
void CheckNumberOfVertices(double area, const LevelImage& image, double delta);

/**
 * Throw std::invalid_argument if a surface does not overlap the image, or is so large that its
 * coordinates must have another unit.
 */
void CheckOverlapsImage(const IndexedSurface& surface, const LevelImage& image);

/** Radius, in delta, of the smallest icosahedron with legal edges. */
constexpr double SmallestSeed = 0.96;

/**
 * Return the value of the field at each centre: positive inside the object.
 * @throws std::invalid_argument if a centre lies outside the image
 */
std::vector<float> ValuesAtSeeds(const Field& field, const std::vector<Point>& centres);

/**
 * Return the centres inside the object, at least `spacing` from each other. Without centres, return
 * points of a grid of this spacing.
 * @throws std::invalid_argument if a centre lies outside the image or none is left
 */
std::vector<Point> ChooseSeeds(
  const Field& field, const std::vector<Point>& centres, double spacing);
}

#endif

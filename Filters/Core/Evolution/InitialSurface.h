// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInitialSurface_h
#define volumicInitialSurface_h

#include "Core/Image/Field.h"
#include "Core/Image/LevelImage.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/** An icosahedron with corners on the sphere, workspace, outward oriented. */
IndexedSurface Icosahedron(const Point& centre, double radius);

/**
 * An icosahedron divided globally by sqrt 3 on its sphere until its mean edge is below
 * `meanEdge`.
 */
IndexedSurface DividedIcosahedron(const Point& centre, double radius, double meanEdge);

/**
 * The same mapped to a rounded box (|x/a|^4 + |y/b|^4 + |z/c|^4 = 1) that encloses the image: on
 * flat volumes it has far fewer vertices than a sphere and a shorter way to go.
 */
IndexedSurface EnclosingSurface(const LevelImage& image, double meanEdge);

/**
 * Refuses a surface (workspace) that lies wholly outside the image, or is so much larger that its
 * coordinates must be in another unit.
 * @throws std::invalid_argument
 */
void CheckOverlapsImage(const IndexedSurface& surface, const LevelImage& image);

/** Radius, in delta, of the smallest icosahedron with legal edges. */
constexpr double SmallestSeed = 0.96;

/**
 * The centres that can be used: inside the object and at least `spacing` from those before. With
 * no centres given, points of a grid of that spacing.
 * @throws std::invalid_argument when a centre lies outside the image or none is left.
 */
std::vector<Point> ChooseSeeds(
  const Field& field, const std::vector<Point>& centres, double spacing);
}

#endif

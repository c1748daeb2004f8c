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
 * A box with edges and corners cut off that encloses the image and a voxel about it. Whatever the
 * image's proportions, its edges are 1.1 to 2 delta long, legal by eq. (1): collapses and splits
 * have nothing to do before the forces have. It is near the image, and has a short way to go.
 * @throws std::invalid_argument as CheckNumberOfVertices.
 */
IndexedSurface EnclosingSurface(const LevelImage& image, double delta);

/** Refuses a surface of an area (workspace) that would have too many vertices for any memory. */
void CheckNumberOfVertices(double area, const LevelImage& image, double delta);

/**
 * Refuses a surface (workspace) that lies wholly outside the image, or is so much larger that its
 * coordinates must be in another unit.
 * @throws std::invalid_argument
 */
void CheckOverlapsImage(const IndexedSurface& surface, const LevelImage& image);

/** Radius, in delta, of the smallest icosahedron with legal edges. */
constexpr double SmallestSeed = 0.96;

/**
 * Return the value of the field at each centre: positive inside the object.
 * @throws std::invalid_argument if a centre lies outside the image.
 */
std::vector<float> ValuesAtSeeds(const Field& field, const std::vector<Point>& centres);

/**
 * The centres that can be used: inside the object and at least `spacing` from those before. With
 * no centres given, points of a grid of that spacing.
 * @throws std::invalid_argument when a centre lies outside the image or none is left.
 */
std::vector<Point> ChooseSeeds(
  const Field& field, const std::vector<Point>& centres, double spacing);
}

#endif

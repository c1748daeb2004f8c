// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDrawBack_h
#define volumicDrawBack_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Labels/LabelField.h"
#include "Core/Labels/TouchingSurfaces.h"

#include <array>
#include <cstddef>
#include <vector>

namespace volumic
{
/**
 * For surfaces of neighbours that must not meet: insides of the fields of two objects have nothing
 * in common (LabelClaims), so each surface must stay where its own field is positive. Where
 * triangles leave that, the field is lowered, so that the surface goes back when it is revised.
 *
 * @param surface  in coordinates in which voxel (i, j, k) of the map is at (i, j, k)
 * @param original the field as it was settled
 * @param by       how much it is lowered
 * @param field    the one that the surface follows
 * @return the number of these triangles
 */
std::size_t DrawBackWithin(
  const LabelField& original, const IndexedSurface& surface, float by, LabelField& field);

/** The same for triangles where surfaces meet: the voxels that are to be lowered, sorted. */
std::vector<std::array<int, 3>> VoxelsAbout(
  const std::vector<IndexedSurface>& surfaces, const std::vector<SurfaceTriangle>& triangles);
}

#endif

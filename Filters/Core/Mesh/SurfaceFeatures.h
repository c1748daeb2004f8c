// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFeatures_h
#define volumicSurfaceFeatures_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <array>
#include <vector>

namespace volumic
{
/** Features of one closed component, in the unit of the points. */
struct ComponentFeatures
{
  int Vertices = 0;
  int Triangles = 0;
  double Area = 0.;
  double Volume = 0.; ///< Signed: negative for a cavity.
  int Genus = 0;
  Point Centroid = { 0., 0., 0. }; ///< Of the volume; of the area if flat.
  std::array<double, 6> Inertia = { 0., 0., 0., 0., 0., 0. }; ///< xx yy zz xy yz xz, see below.
};

struct SurfaceFeatures
{
  std::vector<ComponentFeatures> Components; ///< Sorted by area, largest first.
  LargeVector<int> ComponentOfTriangle;
  double Area = 0.;
  double Volume = 0.;
  int EulerCharacteristic = 0;
  int Genus = 0; ///< Sum over the components.
};

/**
 * Compute components, areas, volumes and moments of a closed oriented manifold mesh. Inertia is the
 * tensor of the enclosed volume, with density 1, about its centroid. The first three entries are
 * the moments of inertia (xx = integral of y^2 + z^2), the others the products with the sign of the
 * tensor (xy = - integral of x y). For a cavity the tensor has the sign of the volume. The sums are
 * taken in the order of the triangles, so the result does not depend on the executor.
 */
SurfaceFeatures ComputeFeatures(const IndexedSurface& surface, Executor& executor = OnThisThread());
}

#endif

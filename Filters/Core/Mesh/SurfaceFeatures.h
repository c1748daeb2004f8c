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
/** Features of one closed component. Lengths are those of the points given. */
struct ComponentFeatures
{
  int Vertices = 0;
  int Triangles = 0;
  double Area = 0.;
  double Volume = 0.; ///< Signed: negative for a cavity.
  int Genus = 0;
  Point Centroid = { 0., 0., 0. };              ///< Of the enclosed volume (of the area if flat).
  std::array<double, 6> Inertia = { 0., 0., 0., 0., 0., 0. }; ///< xx yy zz xy yz xz, see below.
};

struct SurfaceFeatures
{
  std::vector<ComponentFeatures> Components; ///< 0 = largest area.
  LargeVector<int> ComponentOfTriangle;
  double Area = 0.;
  double Volume = 0.;
  int EulerCharacteristic = 0;
  int Genus = 0; ///< Sum over the components.
};

/**
 * Components, areas, volumes and moments of a closed oriented manifold mesh.
 *
 * Inertia is the tensor of the enclosed solid of density 1 about its centroid: the diagonal holds
 * the moments of inertia (xx = integral of y^2 + z^2), the rest the products with the sign of the
 * tensor (xy = - integral of x y). For a cavity it carries the sign of the volume.
 * Sums run over triangles in order, so results do not depend on threads, which find out what is
 * added up.
 */
SurfaceFeatures ComputeFeatures(
  const IndexedSurface& surface, Executor& executor = OnThisThread());
}

#endif

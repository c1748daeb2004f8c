// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * The shapes of the synthetic scenes as signed distances, without any sampling.
 * Part of SyntheticScenes.cxx; nobody else needs it.
 */

#ifndef volumicSceneShapes_h
#define volumicSceneShapes_h

#include "SyntheticScenes.h"

#include <functional>

namespace volumic::support
{

/** A shape in reference units, of which 64 fill the smallest extent of the volume, around 0. */
struct SceneShape
{
  /** Signed distance to the surface, negative inside, right at least near the surface. */
  std::function<double(const std::array<double, 3>&)> Distance;
  bool Shaded = false;

  // The rest is as in Scene.
  int Components = 1;
  int Genus = 0;
  int ComponentsFromOutside = 1;
  int GenusFromOutside = 0;
  std::vector<std::array<double, 3>> Seeds;
  double SeedRadius = 0.0;
  int CoarsestFaithfulLevel = 0;
};

/** Walls that are said to be thin get `thinWall` as thickness, in reference units. */
SceneShape MakeSceneShape(SceneKind kind, double thinWall);

} // namespace volumic::support

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#ifndef volumicSceneShapes_h
#define volumicSceneShapes_h

#include "SyntheticScenes.h"

#include <functional>

namespace volumic::support
{

/** A shape around 0. The smallest extent of the volume is 64 reference units. */
struct SceneShape
{
  /** Signed distance, negative inside, accurate near the surface. */
  std::function<double(const std::array<double, 3>&)> Distance;
  bool Shaded = false;

  // As in Scene.
  int Components = 1;
  int Genus = 0;
  int ComponentsFromOutside = 1;
  int GenusFromOutside = 0;
  std::vector<std::array<double, 3>> Seeds;
  double SeedRadius = 0.0;
  int CoarsestFaithfulLevel = 0;
};

/** Return a shape. @param thinWall thickness of thin walls, reference units */
SceneShape MakeSceneShape(SceneKind kind, double thinWall);

} // namespace volumic::support

#endif

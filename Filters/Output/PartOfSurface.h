// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPartOfSurface_h
#define volumicPartOfSurface_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Mesh/SurfaceFeatures.h"

#include <vector>

namespace volumic
{
/**
 * Some components of a surface, with all that it knows of their points and triangles, which keep
 * their order.
 * @param isKept by component
 */
SurfaceResult PartOf(const SurfaceResult& surface, const SurfaceFeatures& features,
  const std::vector<bool>& isKept);
}

#endif

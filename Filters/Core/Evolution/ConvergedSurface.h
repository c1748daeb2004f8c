// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicConvergedSurface_h
#define volumicConvergedSurface_h

#include "Core/Evolution/EvolutionHistory.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * Converged surface of a level: all that a finer level needs. A division recomputes grid, shapes
 * and pairs. Its result depends on the positions and the order of the vertices, and on the order of
 * neighbours in their rings.
 */
struct ConvergedSurface
{
  SurfaceMesh Mesh;
  int Level = 0;
  float Delta = 0.f;
  int Unchecked = 1; ///< starts, cuts and deletions since the last test for inverted components
  EvolutionHistory History; ///< of all levels so far
};
}

#endif

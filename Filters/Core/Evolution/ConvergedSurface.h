// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicConvergedSurface_h
#define volumicConvergedSurface_h

#include "Core/Evolution/EvolutionHistory.h"
#include "Core/Mesh/SurfaceMesh.h"

namespace volumic
{
/**
 * A surface that rests on a level: all that a finer level needs. A division lays grid, order,
 * shapes and pairs anew: what is to come depends on the positions of the vertices, their order, and
 * their rings, from the first neighbour on.
 */
struct ConvergedSurface
{
  SurfaceMesh Mesh;
  int Level = 0;
  float Delta = 0.f;
  int Unchecked = 1; ///< Starts, cuts and deletions since components were judged from outside in.
  EvolutionHistory History; ///< Of all levels.
};
}

#endif

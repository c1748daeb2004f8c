// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceFit_h
#define volumicInterfaceFit_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <cstddef>

namespace volumic
{
/**
 * Shifts all fields so that, to first order, each object but 0, which is what is about the
 * others, gets the volume of its voxels: an interface moves by half of what its two fields are
 * shifted by, over the slope of half of their difference. The equations, one per object, are a
 * Laplacian whose weights are the areas between two objects.
 * @param tolerance how far faces may be from the interfaces of the fields; workspace
 * @return by which share of its voxels' volume that of an object of 8 or more is off, at most
 */
double CorrectVolumes(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor);

/**
 * Changes fields at voxels that the mesh has on the wrong side, so that the next steps take
 * interfaces past them.
 * @param tolerance those nearer to the interfaces are not wrong, in smallest distances of voxels
 * @return how many there are
 */
std::size_t PushMisclassifiedVoxels(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor);
}

#endif

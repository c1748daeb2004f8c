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
 * Shift all fields so that each object except for the background gets the volume of its voxels, to
 * first order. An interface moves by half the difference of the shifts of its two fields, divided
 * by the slope of half the difference of the fields. The equations, one per object, are a graph
 * Laplacian weighted by the areas between objects.
 * @param tolerance allowed distance of faces from the interfaces of the fields, computational space
 * @return largest relative volume error of the objects with at least 8 voxels
 */
double CorrectVolumes(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor);

/**
 * Change the fields at misclassified voxels, so that the next steps move the interfaces past them.
 * @param tolerance voxels nearer to an interface are not counted, in the smallest voxel spacing
 * @return number of misclassified voxels
 */
std::size_t PushMisclassifiedVoxels(
  const InterfaceMesh& mesh, InterfaceFields& fields, double tolerance, Executor& executor);
}

#endif

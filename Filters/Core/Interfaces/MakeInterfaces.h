// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMakeInterfaces_h
#define volumicMakeInterfaces_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <functional>

namespace volumic
{
/**
 * The interfaces of all objects of a label map, as one conforming mesh without intersections: made
 * of the lattice that its voxels are of, then remeshed to edges of one length while its vertices
 * come to lie where the fields of the objects beside them are the same.
 *
 * @param fields   are changed where triangles cut voxels off
 * @param edge     mean length of edges that is wanted; workspace
 * @param progress told the share that is done; after false the mesh is what there is by then, safe
 *                 but rough
 */
InterfaceMesh MakeInterfaces(InterfaceFields& fields, double edge, Executor& executor,
  const std::function<bool(double share)>& progress);
}

#endif

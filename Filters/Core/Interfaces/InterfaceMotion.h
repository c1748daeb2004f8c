// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceMotion_h
#define volumicInterfaceMotion_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"
#include "Core/Interfaces/VertexTargets.h"

namespace volumic
{
/**
 * Move all vertices simultaneously, in several steps (VertexTargets). After the last step, vertices
 * of triangles that intersect, have turned too far or have become too narrow are moved back to
 * their initial positions. The result has no intersections, as the initial mesh has none. Lengths
 * are in computational space.
 *
 * @param tolerance  triangles at a smaller distance count as intersecting
 * @param leastAngle no angle of a triangle is reduced below this angle, in radians
 * @see VertexTargets for the other parameters
 */
void MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, int steps,
  double relaxation, double shortest, double tolerance, double leastAngle, Executor& executor,
  double straightening = MostStraightening, double mostOfEdge = MostOfEdge);
}

#endif

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
 * Steps of all vertices at once: along their interface or junction line to the middle of their
 * neighbours, by this share of the way, then to where the fields of all objects about them are the
 * same (Newton). No vertex goes further than `mostOfEdge` of its shortest edge in a step. Those whose triangles
 * intersect after the last one, have turned too far, or have become too narrow, are taken back to
 * where they were before the first, which is safe as all was safe then.
 *
 * @param shortest      no edge is made shorter than that; workspace
 * @param tolerance     nearer than that triangles are never; workspace
 * @param leastAngle    of triangles, radian: those that have a smaller one have had it before
 * @param straightening see VertexTargets
 */
void MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, int steps, double share,
  double shortest, double tolerance, double leastAngle, Executor& executor,
  double straightening = MostStraightening, double mostOfEdge = MostOfEdge);
}

#endif

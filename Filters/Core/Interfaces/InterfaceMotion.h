// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceMotion_h
#define volumicInterfaceMotion_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

namespace volumic
{
/**
 * One step of all vertices at once: along their interface or junction line to the middle of their
 * neighbours, by this share of the way, then to where the fields of all objects about them are the
 * same (Newton). No vertex goes further than half of its shortest edge; those whose triangles would
 * intersect, or turn too far, stay where they are, which is safe as all was safe before.
 *
 * @param shortest  no edge is made shorter than that; workspace
 * @param tolerance nearer than that triangles are never; workspace
 * @return the largest way, in the workspace
 */
double MoveInterfaces(InterfaceMesh& mesh, const InterfaceFields& fields, double share,
  double shortest, double tolerance, Executor& executor);
}

#endif

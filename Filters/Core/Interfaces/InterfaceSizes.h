// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInterfaceSizes_h
#define volumicInterfaceSizes_h

#include "Core/Common/Executor.h"
#include "Core/Common/Grading.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <vector>

namespace volumic
{
struct SizeBounds
{
  double Tolerance; ///< allowed distance of faces from the interfaces of the fields
  double Growth;    ///< maximum growth factor of a size per call
  double Most;      ///< maximum size
  double Gradation; ///< maximum growth of sizes per length, along interfaces and across space
};

/**
 * Adjust the vertex sizes of a mesh to a tolerance, as GradedSizes does for surfaces. The error is
 * the distance of the middles of faces and edges from the interfaces, minus that of their corners,
 * as vertices of junction lines are displaced on purpose (VertexTargets).
 */
void AdjustSizes(
  InterfaceMesh& mesh, const InterfaceFields& fields, const SizeBounds& bounds, Executor& executor);

/** Measure the distances of face centres and edge middles from the interfaces of the fields. */
Fit MeasureFit(const InterfaceMesh& mesh, const InterfaceFields& fields,
  const std::vector<int>& faces, double tolerance);
}

#endif

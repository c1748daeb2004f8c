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
/** What the sizes of interfaces may be. */
struct SizeBounds
{
  double Tolerance; ///< how far faces may be from where their objects' fields are the same; workspace
  double Growth;    ///< by what factor a size may grow
  double Most;      ///< what it may be
  double Gradation; ///< by how much sizes may grow per length, along interfaces and across space
};

/**
 * Changes the sizes of a mesh towards what keeps a tolerance, as those of a graded surface are
 * (GradedSizes): from how far the middles of faces and edges are from the interfaces, less how far
 * their corners are, as vertices of junction lines are off on purpose.
 */
void AdjustSizes(InterfaceMesh& mesh, const InterfaceFields& fields, const SizeBounds& bounds,
  Executor& executor);

/** How far faces are from where their objects' fields are the same, in their middles and their edges'. */
Fit MeasureFit(const InterfaceMesh& mesh, const InterfaceFields& fields,
  const std::vector<int>& faces, double tolerance);
}

#endif

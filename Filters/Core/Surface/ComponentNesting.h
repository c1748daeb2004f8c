// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentNesting_h
#define volumicComponentNesting_h

#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <vector>

namespace volumic
{
/**
 * The components that are inside out: a cavity must lie inside the others, any other one outside.
 * They are judged from outside in, as if what is inside out were not there. Rays along x: O(n +
 * pairs of ray and triangle that overlap).
 *
 * @param labels of the components, from 0, by vertex
 * @param roots  the smallest vertex of each
 * @return their roots, those within fewer others first. The same for any executor.
 */
std::vector<int> FindInsideOut(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor);
}

#endif

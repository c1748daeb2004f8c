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
 * They are judged from outside in, as if what is inside out were not there. Rays along x: O(n + pairs
 * of ray and triangle that overlap). The same for any executor.
 * @param labels of vertices, from 0 @param roots a vertex of each label
 * @return the roots of those that are inside out, those within fewer others first
 */
std::vector<int> FindInsideOut(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<int>& roots, Executor& executor);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTouchingSurfaces_h
#define volumicTouchingSurfaces_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

#include <vector>

namespace volumic
{
/**
 * Of each of some closed surfaces the triangles, from first to last, that touch or cross another
 * one, by exact tests.
 * @param surfaces in coordinates in which voxel (i, j, k) of the map is at (i, j, k)
 */
std::vector<std::vector<int>> FindTouching(
  const std::vector<IndexedSurface>& surfaces, Executor& executor);
}

#endif

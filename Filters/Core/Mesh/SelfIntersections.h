// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSelfIntersections_h
#define volumicSelfIntersections_h

#include "Core/Common/IndexedSurface.h"

namespace volumic
{
/** Counters of an intersection search, for tests of its cost. */
struct IntersectionCounters
{
  long long Boxes = 0; ///< Tested nodes of the tree.
  long long Pairs = 0; ///< Tested pairs of triangles.
};

/**
 * Return the number of intersecting pairs of triangles, neighbours included. Conservative tests
 * (TrianglesIntersect) are applied to the points rounded to float. Triangles of all sizes may be
 * mixed: n log n boxes are tested, and the pairs whose boxes overlap. Counting stops at `limit` (0:
 * no limit).
 */
int CountSelfIntersections(
  const IndexedSurface& surface, int limit = 0, IntersectionCounters* counters = nullptr);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSelfIntersections_h
#define volumicSelfIntersections_h

#include "Core/Common/IndexedSurface.h"

#include <vector>

namespace volumic
{
class TriangleTree;

/** What a search for intersections has looked at. */
struct IntersectionCounters
{
  long long Boxes = 0; ///< Of the tree.
  long long Pairs = 0; ///< Of triangles.
};

/**
 * Number of intersecting pairs of triangles, neighbours included, by conservative tests
 * (TrianglesIntersect) of the points rounded to float. Triangles of all sizes may be mixed: the
 * time is that of n log n boxes, and of the pairs whose boxes overlap. Stops counting at `limit`
 * (0: never).
 */
int CountSelfIntersections(
  const IndexedSurface& surface, int limit = 0, IntersectionCounters* work = nullptr);

/**
 * The triangles, from first to last, that another surface intersects, or comes nearer to than
 * `tolerance`; points are rounded to float.
 * @param tree of the other surface
 */
std::vector<int> FindIntersecting(const IndexedSurface& surface, const IndexedSurface& other,
  const TriangleTree& tree, double tolerance);
}

#endif

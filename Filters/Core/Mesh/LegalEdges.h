// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLegalEdges_h
#define volumicLegalEdges_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

namespace volumic
{
/**
 * A closed manifold with its edges brought within bounds: longer ones are halved, which leaves the
 * surface where it is; of shorter ones those are collapsed about which faces turn little. That
 * nothing intersects must be asked afterwards. Lengths: that of the points.
 * @throws std::invalid_argument as SurfaceMesh::Append
 */
IndexedSurface WithLegalEdges(
  const IndexedSurface& surface, float shortest, float longest, Executor& executor);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLegalEdges_h
#define volumicLegalEdges_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"

namespace volumic
{
/**
 * Return a closed manifold with edge lengths brought towards [shortest, longest]. Longer edges are
 * bisected, which keeps the surface. Shorter edges are collapsed where no face turns by more than
 * 45 degrees. The caller must test the result for self-intersections.
 * @throws std::invalid_argument as SurfaceMesh::Append
 */
IndexedSurface WithLegalEdges(
  const IndexedSurface& surface, float shortest, float longest, Executor& executor);
}

#endif

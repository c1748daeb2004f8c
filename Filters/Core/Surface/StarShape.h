// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarShape_h
#define volumicStarShape_h

#include "Core/Surface/NormalCone.h"
#include "Core/Surface/StarFaces.h"

namespace volumic
{
/** The edges of a star, from its vertex on, and the faces between them. */
struct StarShape : StarLink
{
  StarShape(const SurfaceMesh& mesh, int v);

  NormalCone Cone() const;
  /** Whether the angles opposite to each edge exceed 180 degrees by no more than a little. */
  bool IsDelaunay() const;

  StarVectors Edge;
  StarNumbers Length; ///< Of the edges.
  StarVectors Normal; ///< Of face i, between the edges i and i + 1.
  StarNumbers Size;   ///< Twice its area: the normal's length.
  StarNumbers Inner;  ///< Product of its two edges.
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStarShape_h
#define volumicStarShape_h

#include "Core/Surface/NormalCone.h"
#include "Core/Surface/StarFaces.h"

namespace volumic
{
/** The edges of a star, as vectors from its vertex, and its faces. */
struct StarShape : StarLink
{
  StarShape(const SurfaceMesh& mesh, int v);

  NormalCone Cone() const;
  /** Return whether no two angles opposite to an edge exceed 180 degrees noticeably. */
  bool IsDelaunay() const;

  StarVectors Edge;
  StarNumbers Length; ///< Of the edges.
  StarVectors Normal; ///< Of face i, between the edges i and i + 1.
  StarNumbers Size;   ///< Length of Normal: twice the area.
  StarNumbers Inner;  ///< Scalar product of the two edges.
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicJunctionWedges_h
#define volumicJunctionWedges_h

#include "Core/Interfaces/InterfaceMesh.h"

#include <array>
#include <limits>
#include <vector>

namespace volumic
{
/** What lies between two interfaces that are next to each other about an edge of a junction line.
 */
struct JunctionWedge
{
  std::array<int, 2> Edge = { -1, -1 };
  std::array<int, 2> Faces = { -1, -1 };
  double Angle = std::numeric_limits<double>::infinity(); ///< radian
};

/** The wedge between the faces at an edge that is the narrowest. */
JunctionWedge NarrowestWedgeAt(
  const InterfaceMesh& mesh, const std::array<int, 2>& edge, const std::vector<int>& faces);

/** The narrowest wedge of some edges of lines; without an edge where there are none. */
JunctionWedge NarrowestWedge(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines);
inline JunctionWedge NarrowestWedge(const InterfaceMesh& mesh)
{
  return NarrowestWedge(mesh, mesh.FindLines());
}

/** Return how many triangles have such edges on all sides: two objects touch there by one alone. */
int CountContactsOfOneTriangle(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines);
}

#endif

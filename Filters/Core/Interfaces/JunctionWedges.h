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
/** Dihedral wedge between two neighbouring faces at an edge of a junction line. */
struct JunctionWedge
{
  std::array<int, 2> Edge = { -1, -1 };
  std::array<int, 2> Faces = { -1, -1 };
  double Angle = std::numeric_limits<double>::infinity(); ///< dihedral angle in radians
};

JunctionWedge NarrowestWedgeAt(
  const InterfaceMesh& mesh, const std::array<int, 2>& edge, const std::vector<int>& faces);

/** Return the wedge with the smallest dihedral angle at some edges; Edge is -1 if none exist. */
JunctionWedge NarrowestWedge(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines);
inline JunctionWedge NarrowestWedge(const InterfaceMesh& mesh)
{
  return NarrowestWedge(mesh, mesh.FindLines());
}

/** Return the number of triangles with three edges on lines: the only contact of two objects. */
int CountContactsOfOneTriangle(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines);
}

#endif

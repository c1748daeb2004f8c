// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/JunctionWedges.h"

#include "Core/Interfaces/InterfaceClearance.h"

#include <cmath>
#include <cstddef>

namespace volumic
{
JunctionWedge NarrowestWedgeAt(
  const InterfaceMesh& mesh, const std::array<int, 2>& edge, const std::vector<int>& faces)
{
  const auto across = [&](int f) { return AcrossEdge(TriangleAt(mesh, f), edge[0], edge[1]); };
  // The pair with the smallest angle is always a pair of neighbouring faces.
  JunctionWedge narrowest;
  for (std::size_t n = 0; n < faces.size(); ++n)
  {
    for (std::size_t m = n + 1; m < faces.size(); ++m)
    {
      const VectorD a = across(faces[n]);
      const VectorD b = across(faces[m]);
      const double angle = std::atan2(Length(Cross(a, b)), Dot(a, b));
      if (angle < narrowest.Angle)
      {
        narrowest = { edge, { faces[n], faces[m] }, angle };
      }
    }
  }
  return narrowest;
}

JunctionWedge NarrowestWedge(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines)
{
  JunctionWedge narrowest;
  std::vector<int> faces;
  for (const std::array<int, 2>& edge : lines)
  {
    mesh.FindFaces(edge[0], edge[1], faces);
    const JunctionWedge wedge = NarrowestWedgeAt(mesh, edge, faces);
    narrowest = wedge.Angle < narrowest.Angle ? wedge : narrowest;
  }
  return narrowest;
}

int CountContactsOfOneTriangle(
  const InterfaceMesh& mesh, const std::vector<std::array<int, 2>>& lines)
{
  std::vector<unsigned char> sides(mesh.Faces.size(), 0);
  std::vector<int> faces;
  int count = 0;
  for (const std::array<int, 2>& edge : lines)
  {
    mesh.FindFaces(edge[0], edge[1], faces);
    for (const int f : faces)
    {
      const bool isWhole = ++sides[static_cast<std::size_t>(f)] == 3;
      count += isWhole && !mesh.IsSide(mesh.Faces[static_cast<std::size_t>(f)].Front) ? 1 : 0;
    }
  }
  return count;
}
}

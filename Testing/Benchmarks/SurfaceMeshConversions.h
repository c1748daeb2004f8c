// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** CGAL's surfaces as those of the judge. Inline: only who includes it needs CGAL. */

#ifndef volumicSurfaceMeshConversions_h
#define volumicSurfaceMeshConversions_h

#include "TriangleSurface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace volumic::bench
{

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

/** The mesh must have no garbage. */
inline support::TriangleSurface ToTriangleSurface(const CgalMesh& mesh)
{
  support::TriangleSurface surface;
  for (const auto v : mesh.vertices())
  {
    const CgalKernel::Point_3& p = mesh.point(v);
    surface.Points.push_back({ p.x(), p.y(), p.z() });
  }
  for (const auto f : mesh.faces())
  {
    std::array<int, 3> corners;
    int c = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
    {
      corners[c++] = static_cast<int>(v.idx());
    }
    surface.Triangles.push_back(corners);
  }
  return surface;
}

} // namespace volumic::bench

#endif

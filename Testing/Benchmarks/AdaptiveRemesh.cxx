// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * CGAL's adaptive remeshing of a surface, a peer of benchmark_graded.py:
 *
 *     AdaptiveRemesh IN.ply OUT.ply TOLERANCE SHORTEST LONGEST
 *
 * SHORTEST and LONGEST bound what the curvature and the tolerance ask of an edge.
 */

#include "SurfaceMeshConversions.h"

#include <CGAL/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/Adaptive_sizing_field.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <exception>
#include <iostream>
#include <string>
#include <utility>

int main(int count, char** words)
{
  namespace processing = CGAL::Polygon_mesh_processing;
  volumic::bench::CgalMesh mesh;
  if (count != 6 || !CGAL::IO::read_polygon_mesh(std::string(words[1]), mesh))
  {
    std::cerr << "AdaptiveRemesh: no surface that is manifold\n";
    return 1;
  }
  try
  {
    const std::pair<double, double> bounds(std::stod(words[4]), std::stod(words[5]));
    processing::Adaptive_sizing_field<volumic::bench::CgalMesh> sizing(
      std::stod(words[3]), bounds, faces(mesh), mesh);
    processing::isotropic_remeshing(
      faces(mesh), sizing, mesh, CGAL::parameters::number_of_iterations(3));
  }
  catch (const std::exception& error)
  {
    std::cerr << "AdaptiveRemesh: " << error.what() << '\n';
    return 1;
  }
  mesh.collect_garbage();
  return CGAL::IO::write_polygon_mesh(std::string(words[2]), mesh) ? 0 : 1;
}

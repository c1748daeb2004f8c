// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfacePeers.h"

#include "SupportVtkConversions.h"

#include <vtkFlyingEdges3D.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <stdexcept>

namespace volumic
{
namespace bench
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh ToMesh(const support::TriangleSurface& surface)
{
  Mesh mesh;
  for (const auto& p : surface.Points)
  {
    mesh.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
  }
  for (const auto& t : surface.Triangles)
  {
    if (mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]),
          Mesh::Vertex_index(t[2])) == Mesh::null_face())
    {
      throw std::runtime_error("the marching surface is not manifold");
    }
  }
  return mesh;
}

support::TriangleSurface ToSurface(Mesh& mesh)
{
  mesh.collect_garbage();
  support::TriangleSurface surface;
  for (const auto v : mesh.vertices())
  {
    const Kernel::Point_3& p = mesh.point(v);
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

} // namespace

support::TriangleSurface RemeshedMarchingSurface(
  vtkImageData* image, double isoValue, double edgeLength)
{
  vtkNew<vtkImageData> inVoxels;
  inVoxels->ShallowCopy(image);
  inVoxels->SetOrigin(0.0, 0.0, 0.0);
  inVoxels->SetSpacing(1.0, 1.0, 1.0);
  vtkNew<vtkFlyingEdges3D> marching;
  marching->SetInputData(inVoxels);
  marching->SetValue(0, isoValue);
  marching->ComputeNormalsOff();
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputConnection(marching->GetOutputPort());
  largest->SetExtractionModeToLargestRegion();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(largest->GetOutputPort());
  smooth->NormalizeCoordinatesOn();
  smooth->Update();

  Mesh mesh = ToMesh(support::ToTriangleSurface(smooth->GetOutput()));
  CGAL::Polygon_mesh_processing::isotropic_remeshing(
    faces(mesh), edgeLength, mesh, CGAL::parameters::number_of_iterations(3));
  return ToSurface(mesh);
}

} // namespace bench
} // namespace volumic

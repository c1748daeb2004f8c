// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceMeshConversions.h"
#include "SurfacePeersVtk.h"

#include <vtkCellArray.h>

#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace volumic::bench
{
namespace
{

/** Points that no triangle uses, left by the choice of the largest component, stay behind. */
void Fill(vtkPolyData* surface, CgalMesh& mesh)
{
  std::vector<CgalMesh::Vertex_index> vertices(
    static_cast<std::size_t>(surface->GetNumberOfPoints()));
  const auto vertexAt = [&](vtkIdType point)
  {
    CgalMesh::Vertex_index& vertex = vertices[static_cast<std::size_t>(point)];
    if (vertex == CgalMesh::null_vertex())
    {
      double place[3];
      surface->GetPoint(point, place);
      vertex = mesh.add_vertex(CgalKernel::Point_3(place[0], place[1], place[2]));
    }
    return vertex;
  };
  vtkCellArray* triangles = surface->GetPolys();
  for (vtkIdType t = 0; t < triangles->GetNumberOfCells(); ++t)
  {
    vtkIdType size;
    const vtkIdType* corners;
    triangles->GetCellAtId(t, size, corners);
    if (size != 3 ||
      mesh.add_face(vertexAt(corners[0]), vertexAt(corners[1]), vertexAt(corners[2])) ==
        CgalMesh::null_face())
    {
      throw std::runtime_error("the marching surface is not manifold");
    }
  }
}

} // namespace

SurfaceJob RemeshedJob(vtkImageData* image, double isoValue, double edgeLength)
{
  const auto mesh = std::make_shared<CgalMesh>();
  SurfaceJob job;
  job.Work = [=]()
  {
    Fill(Smoothed(image, isoValue), *mesh);
    CGAL::Polygon_mesh_processing::isotropic_remeshing(
      faces(*mesh), edgeLength, *mesh, CGAL::parameters::number_of_iterations(3));
    mesh->collect_garbage();
  };
  job.Result = [mesh]() { return ToTriangleSurface(*mesh); };
  return job;
}

} // namespace volumic::bench

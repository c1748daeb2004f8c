// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceMeshConversions.h"
#include "SurfacePeersVtk.h"

#include <vtkCellArray.h>

#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <memory>
#include <stdexcept>

namespace volumic
{
namespace bench
{
namespace
{

void Fill(vtkPolyData* surface, CgalMesh& mesh)
{
  for (vtkIdType p = 0; p < surface->GetNumberOfPoints(); ++p)
  {
    double place[3];
    surface->GetPoint(p, place);
    mesh.add_vertex(CgalKernel::Point_3(place[0], place[1], place[2]));
  }
  vtkCellArray* triangles = surface->GetPolys();
  for (vtkIdType t = 0; t < triangles->GetNumberOfCells(); ++t)
  {
    vtkIdType size;
    const vtkIdType* corners;
    triangles->GetCellAtId(t, size, corners);
    const auto corner = [corners](int c)
    { return CgalMesh::Vertex_index(static_cast<CgalMesh::size_type>(corners[c])); };
    if (size != 3 || mesh.add_face(corner(0), corner(1), corner(2)) == CgalMesh::null_face())
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

} // namespace bench
} // namespace volumic

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelPeers.h"

#include "SupportVtkConversions.h"
#include "SurfaceMeshConversions.h"

#include <vtkDiscreteFlyingEdges3D.h>
#include <vtkWindowedSincPolyDataFilter.h>
#if defined(VOLUMIC_BENCHMARK_SURFACE_NETS)
#include <vtkSurfaceNets3D.h>
#endif

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <memory>

namespace volumic::bench
{
namespace
{

using Surface = vtkSmartPointer<vtkPolyData>;

SurfaceJob PolyDataJob(const std::function<Surface()>& make)
{
  const auto made = std::make_shared<Surface>();
  SurfaceJob job;
  job.Work = [made, make]() { *made = make(); };
  job.Result = [made]() { return support::ToTriangleSurface(*made); };
  return job;
}

Surface Windowed(vtkImageData* image, int label, int iterations, double passBand)
{
  vtkNew<vtkDiscreteFlyingEdges3D> marching;
  marching->SetInputData(image);
  marching->SetValue(0, label);
  marching->ComputeNormalsOff();
  marching->ComputeScalarsOff();
  vtkNew<vtkWindowedSincPolyDataFilter> smooth;
  smooth->SetInputConnection(marching->GetOutputPort());
  smooth->SetNumberOfIterations(iterations);
  smooth->SetPassBand(passBand);
  smooth->BoundarySmoothingOff();
  smooth->FeatureEdgeSmoothingOff();
  smooth->NonManifoldSmoothingOn();
  smooth->NormalizeCoordinatesOn();
  smooth->Update();
  return smooth->GetOutput();
}

/** False where it is not manifold. */
bool Fill(const support::TriangleSurface& surface, CgalMesh& mesh)
{
  for (const auto& p : surface.Points)
  {
    mesh.add_vertex(CgalKernel::Point_3(p[0], p[1], p[2]));
  }
  const auto vertex = [](int v) { return CgalMesh::Vertex_index(static_cast<unsigned int>(v)); };
  for (const auto& t : surface.Triangles)
  {
    if (mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2])) == CgalMesh::null_face())
    {
      return false;
    }
  }
  return true;
}

void FillInParts(const support::TriangleSurface& surface, CgalMesh& mesh)
{
  std::vector<CgalKernel::Point_3> points;
  for (const auto& p : surface.Points)
  {
    points.emplace_back(p[0], p[1], p[2]);
  }
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& t : surface.Triangles)
  {
    triangles.push_back({ static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
      static_cast<std::size_t>(t[2]) });
  }
  mesh.clear();
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, triangles);
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
}

} // namespace

//------------------------------------------------------------------------------
SurfaceJob WindowedLabelJob(vtkImageData* image, int label, int iterations, double passBand)
{
  return PolyDataJob([=]() { return Windowed(image, label, iterations, passBand); });
}

SurfaceJob RemeshedLabelJob(vtkImageData* image, int label, double edgeLength)
{
  const auto mesh = std::make_shared<CgalMesh>();
  SurfaceJob job;
  job.Work = [=]()
  {
    const support::TriangleSurface surface =
      support::ToTriangleSurface(Windowed(image, label, 20, 0.1));
    if (!Fill(surface, *mesh))
    {
      FillInParts(surface, *mesh);
    }
    CGAL::Polygon_mesh_processing::isotropic_remeshing(
      faces(*mesh), edgeLength, *mesh, CGAL::parameters::number_of_iterations(3));
    mesh->collect_garbage();
  };
  job.Result = [mesh]() { return ToTriangleSurface(*mesh); };
  return job;
}

#if defined(VOLUMIC_BENCHMARK_SURFACE_NETS)
SurfaceJob NetsLabelJob(vtkImageData* image, int label)
{
  return PolyDataJob(
    [=]()
    {
      vtkNew<vtkSurfaceNets3D> nets;
      nets->SetInputData(image);
      nets->SetValue(0, label);
      nets->SetOutputMeshTypeToTriangles();
      nets->Update();
      return Surface(nets->GetOutput());
    });
}
#endif

} // namespace volumic::bench

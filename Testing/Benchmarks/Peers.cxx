// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Surface generators of VTK and CGAL.

#include "Benchmark.h"

#include "SupportVtkConversions.h"

#include <vtkCleanPolyData.h>
#include <vtkFlyingEdges3D.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>

#include <cmath>
#include <memory>

namespace volumic::bench
{
namespace
{

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Triangulation = CGAL::Surface_mesh_default_triangulation_3;
using Traits = Triangulation::Geom_traits;
using Point = Traits::Point_3;

/** Convert a mesh without garbage. */
support::TriangleSurface ToSurface(const Mesh& mesh)
{
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

/** Convert to a mesh; cut the surface where it is not manifold. */
void Fill(const support::TriangleSurface& surface, Mesh& mesh)
{
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& p : surface.Points)
  {
    points.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto& t : surface.Triangles)
  {
    triangles.emplace_back(t.begin(), t.end());
  }
  if (!processing::is_polygon_soup_a_polygon_mesh(triangles))
  {
    processing::orient_polygon_soup(points, triangles);
  }
  processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
}

//------------------------------------------------------------------------------
/** The trilinear field of the image minus the iso-value, negative in the object and 1 outside the
    image. Voxels are float, so that the mesher is compiled for one type only. */
class ImplicitField
{
public:
  ImplicitField(vtkImageData* image, double isoValue)
    : Values(std::make_shared<std::vector<float>>()), IsoValue(isoValue)
  {
    image->GetDimensions(this->Size);
    image->GetSpacing(this->Step);
    vtkDataArray* voxels = image->GetPointData()->GetScalars();
    for (vtkIdType v = 0; v < voxels->GetNumberOfTuples(); ++v)
    {
      this->Values->push_back(static_cast<float>(voxels->GetComponent(v, 0)));
    }
  }

  double operator()(const Point& p) const
  {
    const double index[3] = { p.x() / this->Step[0], p.y() / this->Step[1], p.z() / this->Step[2] };
    int corner[3];
    double t[3];
    for (int a = 0; a < 3; ++a)
    {
      if (!(index[a] >= 0.0 && index[a] <= this->Size[a] - 1))
      {
        return 1.0;
      }
      corner[a] = std::min(static_cast<int>(index[a]), this->Size[a] - 2);
      t[a] = index[a] - corner[a];
    }
    const std::ptrdiff_t row = this->Size[0], plane = row * this->Size[1];
    const float* v = this->Values->data() + corner[2] * plane + corner[1] * row + corner[0];
    const auto along = [&t](int a, double x, double y) { return x + t[a] * (y - x); };
    const auto inPlane = [&](const float* w)
    { return along(1, along(0, w[0], w[1]), along(0, w[row], w[row + 1])); };
    return this->IsoValue - along(2, inPlane(v), inPlane(v + plane));
  }

  /** Return the voxel that is farthest inside. */
  Point VoxelInside() const
  {
    const auto v = static_cast<int>(
      std::max_element(this->Values->begin(), this->Values->end()) - this->Values->begin());
    const int row = v / this->Size[0];
    return Point(v % this->Size[0] * this->Step[0], row % this->Size[1] * this->Step[1],
      row / this->Size[1] * this->Step[2]);
  }

  /** Return the radius of a sphere around any point of the image that encloses the image. */
  double EnclosingRadius() const
  {
    return 1.1 *
      std::hypot(this->Size[0] * this->Step[0], this->Size[1] * this->Step[1],
        this->Size[2] * this->Step[2]);
  }

private:
  std::shared_ptr<std::vector<float>> Values;
  int Size[3];
  double Step[3];
  double IsoValue;
};

} // namespace

//------------------------------------------------------------------------------
support::TriangleSurface TrianglesOf(vtkPolyData* surface)
{
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(surface);
  clean->PointMergingOff();
  clean->Update();
  return support::ToTriangleSurface(clean->GetOutput());
}

Job PolyDataJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make)
{
  const auto made = std::make_shared<vtkSmartPointer<vtkPolyData>>();
  return { [made, make]() { *made = make(); }, [made]() { return TrianglesOf(*made); } };
}

vtkSmartPointer<vtkPolyData> FlyingEdges(vtkImageData* image, double isoValue)
{
  vtkNew<vtkFlyingEdges3D> marching;
  marching->SetInputData(image);
  marching->SetValue(0, isoValue);
  marching->ComputeNormalsOff();
  marching->ComputeScalarsOff();
  marching->Update();
  return marching->GetOutput();
}

Job RemeshingJob(const std::function<vtkSmartPointer<vtkPolyData>()>& make, double edgeLength)
{
  const auto mesh = std::make_shared<Mesh>();
  const auto work = [=]()
  {
    mesh->clear();
    Fill(TrianglesOf(make()), *mesh);
    processing::isotropic_remeshing(
      faces(*mesh), edgeLength, *mesh, CGAL::parameters::number_of_iterations(3));
    mesh->collect_garbage();
  };
  return { work, [mesh]() { return ToSurface(*mesh); } };
}

Job MesherJob(vtkImageData* image, vtkPolyData* largest, double isoValue, double radius)
{
  // CGAL's default precision is relative to the enclosing sphere: errors would be tenths of a
  // voxel.
  constexpr double precision = 0.03;
  const auto mesh = std::make_shared<Mesh>();
  // Points of the surface and of the object, which users of this mesher provide, are found outside
  // the measured work. Without surface points it often meshes a small part only.
  const ImplicitField field(image, isoValue);
  const support::TriangleSurface known = TrianglesOf(largest);
  std::vector<Point> given;
  for (std::size_t k = 0; k < known.Points.size(); k += 500)
  {
    given.emplace_back(known.Points[k][0], known.Points[k][1], known.Points[k][2]);
  }
  const Point inside = field.VoxelInside();
  const auto work = [=]()
  {
    const double enclosing = field.EnclosingRadius();
    const CGAL::Implicit_surface_3<Traits, ImplicitField> surface(
      field, Traits::Sphere_3(inside, enclosing * enclosing), precision / enclosing);
    const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30.0, radius, 0.5 * radius);
    Triangulation triangulation(given.begin(), given.end());
    CGAL::Complex_2_in_triangulation_3<Triangulation> complex(triangulation);
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
    mesh->clear();
    CGAL::facets_in_complex_2_to_triangle_mesh(complex, *mesh);
  };
  return { work, [mesh]() { return ToSurface(*mesh); } };
}

} // namespace volumic::bench

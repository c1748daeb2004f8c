// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "SurfaceMeshConversions.h"
#include "SurfacePeers.h"

#include <vtkImageData.h>

#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

namespace volumic::bench
{
namespace
{

using Triangulation = CGAL::Surface_mesh_default_triangulation_3;
using Complex = CGAL::Complex_2_in_triangulation_3<Triangulation>;
using Traits = Triangulation::Geom_traits;
using Point = Traits::Point_3;

/** How well a vertex is put onto the isopotential, in the smallest distance of two voxels. With CGAL's default, a share of the
    enclosing sphere, vertices would be off by tenths of a voxel. */
constexpr double Precision = 0.03;

/** Where a place lies among the voxels: the first of the eight around it, and the way to the last,
    between 0 and 1 along each axis. */
struct Cell
{
  std::ptrdiff_t First;
  std::ptrdiff_t Row;
  std::ptrdiff_t Plane;
  double Share[3];
};

template <typename Value>
double Trilinear(const void* values, const Cell& cell)
{
  const Value* v = static_cast<const Value*>(values) + cell.First;
  const auto along = [&cell](int axis, double a, double b)
  { return a + cell.Share[axis] * (b - a); };
  const auto inPlane = [&](const Value* w)
  { return along(1, along(0, w[0], w[1]), along(0, w[cell.Row], w[cell.Row + 1])); };
  return along(2, inPlane(v), inPlane(v + cell.Plane));
}

/** The trilinear field of the image, less the iso-value, negative in the object. Outside the image
    is air. One class for all types of voxels, or the mesher would be compiled for each. */
class ImplicitField
{
public:
  ImplicitField(vtkImageData* image, double isoValue, bool objectIsBright)
    : Values(image->GetScalarPointer()), IsoValue(isoValue), Sign(objectIsBright ? -1.0 : 1.0)
  {
    image->GetDimensions(this->Size);
    image->GetSpacing(this->Step);
    switch (image->GetScalarType())
    {
      vtkTemplateMacro(this->Interpolate = &Trilinear<VTK_TT>);
      default:
        throw std::runtime_error("no scalars");
    }
  }

  double operator()(const Point& p) const
  {
    const double place[3] = { p.x() / this->Step[0], p.y() / this->Step[1],
      p.z() / this->Step[2] };
    Cell cell;
    cell.Row = this->Size[0];
    cell.Plane = cell.Row * this->Size[1];
    int corner[3];
    for (int a = 0; a < 3; ++a)
    {
      if (!(place[a] >= 0.0 && place[a] <= this->Size[a] - 1))
      {
        return 1.0;
      }
      corner[a] = std::min(static_cast<int>(place[a]), this->Size[a] - 2);
      cell.Share[a] = place[a] - corner[a];
    }
    cell.First = corner[2] * cell.Plane + corner[1] * cell.Row + corner[0];
    return this->Sign * (this->Interpolate(this->Values, cell) - this->IsoValue);
  }

  /** A voxel of the largest part of the object, that nearest to the part's barycentre. */
  Point PlaceInObject() const
  {
    const std::vector<std::array<int, 3>> part = this->LargestPart();
    if (part.empty())
    {
      throw std::runtime_error("no voxel of the object");
    }
    double middle[3] = { 0.0, 0.0, 0.0 };
    for (const auto& voxel : part)
    {
      for (int a = 0; a < 3; ++a)
      {
        middle[a] += static_cast<double>(voxel[a]) / static_cast<double>(part.size());
      }
    }
    const auto squared = [&middle](const std::array<int, 3>& voxel)
    {
      const double x = voxel[0] - middle[0], y = voxel[1] - middle[1], z = voxel[2] - middle[2];
      return x * x + y * y + z * z;
    };
    const auto nearest = std::min_element(part.begin(), part.end(),
      [&](const auto& one, const auto& other) { return squared(one) < squared(other); });
    return this->PlaceOf(*nearest);
  }

  /** Of a sphere around any point in the image that encloses all of it. */
  double EnclosingRadius() const
  {
    return 1.1 *
      std::hypot(this->Size[0] * this->Step[0], this->Size[1] * this->Step[1],
        this->Size[2] * this->Step[2]);
  }

private:
  /** Voxels of the object connected by faces, of the part that has most. The image has a border of
      air, thus no neighbour is outside. */
  std::vector<std::array<int, 3>> LargestPart() const
  {
    const std::ptrdiff_t row = this->Size[0], plane = row * this->Size[1];
    std::vector<char> open(static_cast<std::size_t>(plane * this->Size[2]));
    const auto index = [=](const std::array<int, 3>& v)
    { return v[2] * plane + v[1] * row + v[0]; };
    const auto forEach = [this](const auto& visit)
    {
      for (int k = 0; k < this->Size[2]; ++k)
      {
        for (int j = 0; j < this->Size[1]; ++j)
        {
          for (int i = 0; i < this->Size[0]; ++i)
          {
            visit(std::array<int, 3>{ i, j, k });
          }
        }
      }
    };
    forEach([&](const std::array<int, 3>& v)
      { open[index(v)] = (*this)(this->PlaceOf(v)) < 0.0; });
    std::vector<std::array<int, 3>> largest, part;
    forEach(
      [&](const std::array<int, 3>& start)
      {
        if (!open[index(start)])
        {
          return;
        }
        part.assign(1, start);
        open[index(start)] = 0;
        for (std::size_t done = 0; done < part.size(); ++done)
        {
          for (int side = 0; side < 6; ++side)
          {
            std::array<int, 3> next = part[done];
            next[side / 2] += side % 2 == 0 ? -1 : 1;
            if (open[index(next)])
            {
              open[index(next)] = 0;
              part.push_back(next);
            }
          }
        }
        if (part.size() > largest.size())
        {
          largest.swap(part);
        }
      });
    return largest;
  }

  Point PlaceOf(const std::array<int, 3>& voxel) const
  {
    return Point(voxel[0] * this->Step[0], voxel[1] * this->Step[1], voxel[2] * this->Step[2]);
  }

  const void* Values;
  int Size[3];
  double Step[3];
  double IsoValue;
  double Sign;
  double (*Interpolate)(const void* values, const Cell& cell) = nullptr;
};

} // namespace

double MesherRadius(double edgeLength)
{
  return 0.8 * edgeLength;
}

SurfaceJob MesherJob(vtkImageData* image, double isoValue, bool objectIsBright, double radius)
{
  const auto mesh = std::make_shared<CgalMesh>();
  SurfaceJob job;
  // Where the object is, which the user of this mesher has to know, is found before.
  const ImplicitField field(image, isoValue, objectIsBright);
  const Point inside = field.PlaceInObject();
  job.Work = [=]()
  {
    const double enclosing = field.EnclosingRadius();
    const CGAL::Implicit_surface_3<Traits, ImplicitField> surface(
      field, Traits::Sphere_3(inside, enclosing * enclosing), Precision / enclosing);
    const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30.0, radius, 0.5 * radius);
    Triangulation triangulation;
    Complex complex(triangulation);
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());
    CGAL::facets_in_complex_2_to_triangle_mesh(complex, *mesh);
  };
  job.Result = [mesh]() { return ToTriangleSurface(*mesh); };
  return job;
}

} // namespace volumic::bench

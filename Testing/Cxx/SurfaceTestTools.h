// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceTestTools_h
#define volumicSurfaceTestTools_h

#include "FilterTestTools.h"
#include "vtkDeformableSurface.h"

#include <vtkFeatureEdges.h>
#include <vtkMath.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>

/** What the tests of vtkDeformableSurface share. */
namespace volumic
{
using Choice = ChoiceOf<vtkDeformableSurface>;

/** A filter for the objects of FilterTestTools.h, with what is chosen; not updated yet. */
template <typename Filter = vtkDeformableSurface>
vtkSmartPointer<Filter> FilterOf(vtkDataObject* input, const ChoiceOf<Filter>& choose = {})
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(input);
  filter->SetIsoValue(50.0);
  if (choose)
  {
    choose(filter);
  }
  return filter;
}

/** The updated one. */
template <typename Filter = vtkDeformableSurface>
vtkSmartPointer<Filter> SurfaceOf(vtkDataObject* input, const ChoiceOf<Filter>& choose = {})
{
  const auto filter = FilterOf<Filter>(input, choose);
  filter->Update();
  return filter;
}

/** Value i of a numeric array of the field data, counted over its components; NaN without it. */
inline double FieldOf(vtkPolyData* surface, const char* name, int i = 0)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array
    ? array->GetComponent(i / array->GetNumberOfComponents(), i % array->GetNumberOfComponents())
    : std::nan("");
}

/** The field of that name. */
inline std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}

/** Signed, unlike that of vtkMassProperties: negative if the triangles look inward. */
inline double EnclosedVolume(vtkPolyData* surface)
{
  double volume = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkIdType size;
    const vtkIdType* ids;
    surface->GetCellPoints(c, size, ids);
    double p[3][3];
    for (int corner = 0; corner < 3; ++corner)
    {
      surface->GetPoint(ids[corner], p[corner]);
    }
    double cross[3];
    vtkMath::Cross(p[1], p[2], cross);
    volume += vtkMath::Dot(p[0], cross) / 6.0;
  }
  return volume;
}

/** What is at a level of the output Levels. */
inline vtkPolyData* SurfaceAt(vtkDeformableSurface* filter, unsigned int level)
{
  return vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(level));
}

/** Points without cells. */
inline vtkSmartPointer<vtkPolyData> PointsAt(const std::vector<std::array<double, 3>>& places)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& place : places)
  {
    points->InsertNextPoint(place.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

/** VTK's sphere, with so many sides about its axis and along it. */
inline vtkSmartPointer<vtkPolyData> SphereAt(
  const std::array<double, 3>& centre, double radius, int sides = 8)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(centre[0], centre[1], centre[2]);
  sphere->SetRadius(radius);
  sphere->SetThetaResolution(sides);
  sphere->SetPhiResolution(sides);
  sphere->Update();
  return sphere->GetOutput();
}

/** Calls visit(p, q) with the ends of each edge of each triangle: of those within, twice. */
template <typename Visit>
void VisitEdges(vtkPolyData* surface, const Visit& visit)
{
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkIdType size;
    const vtkIdType* ids;
    surface->GetCellPoints(c, size, ids);
    for (vtkIdType k = 0; k < size; ++k)
    {
      std::array<double, 3> p;
      std::array<double, 3> q;
      surface->GetPoint(ids[k], p.data());
      surface->GetPoint(ids[(k + 1) % size], q.data());
      visit(p, q);
    }
  }
}

/** How many edges do not have two triangles. */
inline int OpenOrNonManifoldEdges(vtkPolyData* surface)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->Update();
  return static_cast<int>(edges->GetOutput()->GetNumberOfCells());
}

/** A closed surface whose points and normals are those of a sphere. */
inline void ExpectSphere(
  vtkPolyData* surface, const double* centre, double radius, double tolerance)
{
  ASSERT_GT(surface->GetNumberOfPoints(), 100);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double* p = surface->GetPoint(i);
    EXPECT_NEAR(std::sqrt(vtkMath::Distance2BetweenPoints(p, centre)), radius, tolerance);
    const double outward[3] = { p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] };
    const double* normal = surface->GetPointData()->GetNormals()->GetTuple(i);
    EXPECT_GT(vtkMath::Dot(normal, outward), 0.9 * radius) << "normals point outward";
  }
  EXPECT_NEAR(EnclosedVolume(surface), 4. / 3. * vtkMath::Pi() * std::pow(radius, 3),
    0.03 * 4. * std::pow(radius, 3));
}

/** The same points, to the bit, and as many triangles. */
inline bool AreSameSurfaces(vtkPolyData* a, vtkPolyData* b)
{
  if (a->GetNumberOfPoints() != b->GetNumberOfPoints() ||
    a->GetNumberOfCells() != b->GetNumberOfCells())
  {
    return false;
  }
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    double p[3];
    double q[3];
    a->GetPoint(i, p);
    b->GetPoint(i, q);
    if (p[0] != q[0] || p[1] != q[1] || p[2] != q[2])
    {
      return false;
    }
  }
  return true;
}

/** BallImage(40, 40, 40). */
constexpr double BallCentre[3] = { 19.5, 19.5, 19.5 };
constexpr double BallRadius = 0.3 * 40;
}

#endif

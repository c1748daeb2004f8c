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

/** Tools for tests of vtkDeformableSurface. */
namespace volumic
{
using Choice = ChoiceOf<vtkDeformableSurface>;

/** Return a filter with iso-value 50 and these settings, not updated. */
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

/** Return an updated filter with iso-value 50 and these settings. */
template <typename Filter = vtkDeformableSurface>
vtkSmartPointer<Filter> SurfaceOf(vtkDataObject* input, const ChoiceOf<Filter>& choose = {})
{
  const auto filter = FilterOf<Filter>(input, choose);
  filter->Update();
  return filter;
}

/** Return component i of a field data array; NaN if the array does not exist. */
inline double FieldOf(vtkPolyData* surface, const char* name, int i = 0)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  return array
    ? array->GetComponent(i / array->GetNumberOfComponents(), i % array->GetNumberOfComponents())
    : std::nan("");
}

inline std::string StopReason(vtkPolyData* surface)
{
  auto* reason =
    vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray("StopReason"));
  return reason ? reason->GetValue(0) : "";
}

/** Return the signed volume: negative if the triangles are oriented inward. */
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

/** Return the surface of a level. */
inline vtkPolyData* SurfaceAt(vtkDeformableSurface* filter, unsigned int level)
{
  return vtkPolyData::SafeDownCast(filter->GetLevels()->GetBlock(level));
}

/** Return points without cells. */
inline vtkSmartPointer<vtkPolyData> PointsAt(const std::vector<std::array<double, 3>>& positions)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& position : positions)
  {
    points->InsertNextPoint(position.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

/** Return a sphere of vtkSphereSource with this resolution. */
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

/** Call visit(p, q) for each edge of each triangle. */
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

/** Count the edges that do not have two triangles. */
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

/** Expect a closed surface with the points and normals of a sphere. */
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

/** Whether the points are bit-identical and the numbers of triangles are equal. */
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

/** Ball of BallImage(40, 40, 40). */
constexpr double BallCentre[3] = { 19.5, 19.5, 19.5 };
constexpr double BallRadius = 0.3 * 40;
}

#endif

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

/** Tools for tests of vtkDeformableSurface. */
namespace volumic
{
using Choice = ChoiceOf<vtkDeformableSurface>;

/** Return a filter with iso-value 50 and these settings, not updated. */
template <typename Filter = vtkDeformableSurface>
vtkSmartPointer<Filter> FilterOf(
  vtkDataObject* input, const ChoiceOf<Filter>& choose = [](Filter*) {})
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(input);
  filter->SetIsoValue(50.0);
  choose(filter);
  return filter;
}

/** Return an updated filter with iso-value 50 and these settings. */
template <typename Filter = vtkDeformableSurface>
vtkSmartPointer<Filter> SurfaceOf(
  vtkDataObject* input, const ChoiceOf<Filter>& choose = [](Filter*) {})
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

inline std::array<double, 3> PointOf(vtkPolyData* surface, vtkIdType id)
{
  std::array<double, 3> p;
  surface->GetPoint(id, p.data());
  return p;
}

/** Return the lengths of the edges of all triangles, sorted. */
inline std::vector<double> EdgeLengthsOf(vtkPolyData* surface)
{
  std::vector<double> lengths;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkIdType size;
    const vtkIdType* ids;
    surface->GetCellPoints(c, size, ids);
    for (vtkIdType k = 0; k < size; ++k)
    {
      const auto p = PointOf(surface, ids[k]);
      const auto q = PointOf(surface, ids[(k + 1) % size]);
      lengths.push_back(std::sqrt(vtkMath::Distance2BetweenPoints(p.data(), q.data())));
    }
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

inline double MeanEdgeOf(vtkPolyData* surface)
{
  const std::vector<double> lengths = EdgeLengthsOf(surface);
  return std::accumulate(lengths.begin(), lengths.end(), 0.) / static_cast<double>(lengths.size());
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
    volume += vtkMath::Determinant3x3(PointOf(surface, ids[0]).data(),
                PointOf(surface, ids[1]).data(), PointOf(surface, ids[2]).data()) /
      6.0;
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

/** Expect that an output ends with a valid surface of this level, not with a finer one. */
inline void ExpectSurfaceOfLevel(vtkDeformableSurface* filter, int level)
{
  vtkPolyData* surface = filter->GetOutput();
  EXPECT_EQ(FieldOf(surface, "Level"), level);
  ASSERT_GT(surface->GetNumberOfPoints(), 0);
  EXPECT_EQ(OpenOrNonManifoldEdges(surface), 0);
  EXPECT_GT(EnclosedVolume(surface), 0.0);
  ASSERT_TRUE(SurfaceAt(filter, level));
  EXPECT_EQ(SurfaceAt(filter, level)->GetNumberOfPoints(), surface->GetNumberOfPoints());
  for (int finer = 0; finer < level; ++finer)
  {
    EXPECT_FALSE(SurfaceAt(filter, finer));
  }
}

inline double VolumeOfBall(double radius)
{
  return 4. / 3. * vtkMath::Pi() * std::pow(radius, 3);
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
  EXPECT_NEAR(EnclosedVolume(surface) / VolumeOfBall(radius), 1., 0.028);
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
    if (PointOf(a, i) != PointOf(b, i))
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

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceOutput.h"

#include "Core/Mesh/SurfaceFeatures.h"
#include "SurfaceTransform.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
namespace
{
template <typename Array, typename Value>
void AddField(vtkPolyData* polyData, const char* name, Value value)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->InsertNextValue(value);
  polyData->GetFieldData()->AddArray(array);
}

/** An array with an entry per component, of as many values as `get` gives. */
template <typename Array, int N, typename Get>
void AddComponentField(
  vtkPolyData* polyData, const char* name, const SurfaceFeatures& features, const Get& get)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(N);
  array->SetNumberOfTuples(static_cast<vtkIdType>(features.Components.size()));
  for (std::size_t c = 0; c < features.Components.size(); ++c)
  {
    for (int i = 0; i < N; ++i)
    {
      array->SetTypedComponent(static_cast<vtkIdType>(c), i, get(features.Components[c], i));
    }
  }
  polyData->GetFieldData()->AddArray(array);
}

/** The same value for all triangles of a component, so that filters of cells can choose by it. */
template <typename Array, typename Get>
void AddComponentOfCells(
  vtkPolyData* polyData, const char* name, const SurfaceFeatures& features, const Get& get)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(static_cast<vtkIdType>(features.ComponentOfTriangle.size()));
  for (std::size_t t = 0; t < features.ComponentOfTriangle.size(); ++t)
  {
    array->SetValue(static_cast<vtkIdType>(t),
      static_cast<typename Array::ValueType>(
        get(features.Components[features.ComponentOfTriangle[t]])));
  }
  polyData->GetCellData()->AddArray(array);
}

/** The size that 98 % of the residuals don't exceed; 0 for none. */
double ResidualQuantile(const std::vector<float>& residuals)
{
  if (residuals.empty())
  {
    return 0.0;
  }
  std::vector<float> sizes(residuals.size());
  std::transform(residuals.begin(), residuals.end(), sizes.begin(),
    [](float residual) { return std::abs(residual); });
  const auto last = static_cast<double>(sizes.size() - 1);
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(0.98 * last);
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place;
}

void SetGeometry(vtkPolyData* polyData, const IndexedSurface& world)
{
  const auto numberOfPoints = static_cast<vtkIdType>(world.Points.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(numberOfPoints);
  for (vtkIdType p = 0; p < numberOfPoints; ++p)
  {
    points->SetPoint(p, world.Points[p].data());
  }
  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact(static_cast<vtkIdType>(world.Triangles.size()),
    3 * static_cast<vtkIdType>(world.Triangles.size()));
  for (const Triangle& triangle : world.Triangles)
  {
    triangles->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  polyData->SetPoints(points);
  polyData->SetPolys(triangles);
}

void SetPointArrays(vtkPolyData* polyData, const SurfaceResult& surface, const Workspace& space)
{
  const auto numberOfPoints = static_cast<vtkIdType>(surface.Points.size());
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(numberOfPoints);
  vtkNew<vtkFloatArray> residual;
  residual->SetName("Residual");
  residual->SetNumberOfTuples(numberOfPoints);
  vtkNew<vtkUnsignedCharArray> motionless;
  motionless->SetName("Motionless");
  motionless->SetNumberOfTuples(numberOfPoints);
  for (vtkIdType p = 0; p < numberOfPoints; ++p)
  {
    normals->SetTypedTuple(p, space.NormalToWorld(surface.Normals[p]).data());
    residual->SetValue(p, surface.Residual[p]);
    motionless->SetValue(p, surface.Motionless[p]);
  }
  polyData->GetPointData()->SetNormals(normals);
  polyData->GetPointData()->AddArray(residual);
  polyData->GetPointData()->AddArray(motionless);
  vtkNew<vtkUnsignedCharArray> contact;
  contact->SetName("Contact");
  contact->SetNumberOfTuples(numberOfPoints);
  std::copy(surface.Held.begin(), surface.Held.end(), contact->GetPointer(0));
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    contact->SetValue(pair[0], 1);
    contact->SetValue(pair[1], 1);
  }
  polyData->GetPointData()->AddArray(contact);
}

void SetFeatures(vtkPolyData* polyData, const SurfaceFeatures& features)
{
  vtkNew<vtkIntArray> component;
  component->SetName("Component");
  component->SetNumberOfTuples(static_cast<vtkIdType>(features.ComponentOfTriangle.size()));
  std::copy(features.ComponentOfTriangle.begin(), features.ComponentOfTriangle.end(),
    component->GetPointer(0));
  polyData->GetCellData()->AddArray(component);
  using Component = ComponentFeatures;
  AddComponentOfCells<vtkFloatArray>(
    polyData, "ComponentArea", features, [](const Component& c) { return c.Area; });
  AddComponentOfCells<vtkFloatArray>(
    polyData, "ComponentVolume", features, [](const Component& c) { return c.Volume; });
  AddComponentOfCells<vtkIntArray>(
    polyData, "ComponentGenus", features, [](const Component& c) { return c.Genus; });

  AddField<vtkIntArray>(
    polyData, "NumberOfComponents", static_cast<int>(features.Components.size()));
  AddField<vtkIntArray>(polyData, "EulerCharacteristic", features.EulerCharacteristic);
  AddField<vtkIntArray>(polyData, "Genus", features.Genus);
  AddField<vtkDoubleArray>(polyData, "Area", features.Area);
  AddField<vtkDoubleArray>(polyData, "Volume", features.Volume);
  AddComponentField<vtkDoubleArray, 1>(
    polyData, "ComponentArea", features, [](const Component& c, int) { return c.Area; });
  AddComponentField<vtkDoubleArray, 1>(
    polyData, "ComponentVolume", features, [](const Component& c, int) { return c.Volume; });
  AddComponentField<vtkIntArray, 1>(
    polyData, "ComponentGenus", features, [](const Component& c, int) { return c.Genus; });
  AddComponentField<vtkDoubleArray, 3>(polyData, "ComponentCentroid", features,
    [](const Component& c, int i) { return c.Centroid[i]; });
  AddComponentField<vtkDoubleArray, 6>(
    polyData, "ComponentInertia", features, [](const Component& c, int i) { return c.Inertia[i]; });
}

}

vtkSmartPointer<vtkPolyData> MakePolyData(
  const SurfaceResult& surface, const SurfaceDescription& description, const Workspace& space)
{
  auto polyData = vtkSmartPointer<vtkPolyData>::New();
  const IndexedSurface world = ToWorld(surface, space);
  SetGeometry(polyData, world);
  SetPointArrays(polyData, surface, space);
  AddField<vtkIntArray>(polyData, "Level", description.Level);
  AddField<vtkDoubleArray>(polyData, "Delta", surface.Delta * space.WorldUnit());
  AddField<vtkDoubleArray>(polyData, "Unit", description.Unit);
  AddField<vtkIntArray>(polyData, "Iterations", description.Iterations);
  AddField<vtkIntArray>(
    polyData, "RemainingContacts", static_cast<int>(surface.Contacts.size()));
  auto* contact =
    vtkUnsignedCharArray::SafeDownCast(polyData->GetPointData()->GetArray("Contact"));
  AddField<vtkIntArray>(polyData, "ContactVertices",
    static_cast<int>(
      std::count(contact->GetPointer(0), contact->GetPointer(surface.Points.size()), 1)));
  AddField<vtkDoubleArray>(polyData, "ResidualQuantile", ResidualQuantile(surface.Residual));
  AddField<vtkIntArray>(polyData, "LostParts", description.LostParts);
  AddField<vtkIntArray>(polyData, "RecoveredParts", description.RecoveredParts);
  AddField<vtkIntArray>(polyData, "MissingParts", description.MissingParts);
  AddField<vtkDoubleArray>(polyData, "MissingBoundary", description.MissingBoundary);
  AddField<vtkIntArray>(polyData, "LostCavities", description.LostCavities);
  AddField<vtkIntArray>(polyData, "RecoveredCavities", description.RecoveredCavities);
  if (description.TotalIterations >= 0)
  {
    AddField<vtkIntArray>(polyData, "Iteration", description.TotalIterations);
  }
  if (!description.StopReason.empty())
  {
    AddField<vtkStringArray>(polyData, "StopReason", description.StopReason.c_str());
  }
  SetFeatures(polyData, ComputeFeatures(world));
  return polyData;
}

void SetStopReason(vtkPolyData* surface, const std::string& reason)
{
  // Not into field data that a shallow copy may share.
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(surface->GetFieldData());
  surface->SetFieldData(fieldData);
  AddField<vtkStringArray>(surface, "StopReason", reason.c_str());
}

vtkSmartPointer<vtkPolyData> MakeStopped(int level, const std::string& reason)
{
  SurfaceDescription description;
  description.Level = level;
  description.StopReason = reason;
  return MakePolyData(SurfaceResult(), description, Workspace());
}
}

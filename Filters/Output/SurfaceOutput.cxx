// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/SurfaceOutput.h"

#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "Host/LargeArrays.h"
#include "Input/ComputationalSpace.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
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
#include <initializer_list>
#include <utility>
#include <variant>
#include <vector>

namespace volumic
{
namespace
{
/** Add an entry of field data for each name, with an integer or a real value. */
void AddFields(vtkPolyData* polyData,
  std::initializer_list<std::pair<const char*, std::variant<int, double>>> fields)
{
  for (const auto& [name, value] : fields)
  {
    if (const int* number = std::get_if<int>(&value))
    {
      AddField<vtkIntArray>(polyData->GetFieldData(), name, *number);
    }
    else
    {
      AddField<vtkDoubleArray>(polyData->GetFieldData(), name, std::get<double>(value));
    }
  }
}

/** Add field data with an entry of N values per component, get(component, i). */
template <typename Array, int N, typename Get>
void AddComponentField(vtkPolyData* polyData, const char* name, std::size_t count, const Get& get)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(N);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t c = 0; c < count; ++c)
  {
    for (int i = 0; i < N; ++i)
    {
      array->SetTypedComponent(static_cast<vtkIdType>(c), i, get(c, i));
    }
  }
  polyData->GetFieldData()->AddArray(array);
}

/** Call body(begin, end) on ranges of n items in parallel. */
template <typename Body>
void ForRanges(Executor& executor, std::size_t n, const Body& body)
{
  constexpr std::size_t size = 16384;
  ForSpans(executor, n, size,
    [&body](std::size_t, std::size_t begin, std::size_t end) { body(begin, end); });
}

template <typename T>
void Free(LargeVector<T>& values)
{
  LargeVector<T>().swap(values);
}

/** Add a cell array with the value of each triangle's component. */
template <typename Array, typename Get>
void AddComponentCellArray(vtkPolyData* polyData, const char* name, const SurfaceFeatures& features,
  Executor& executor, const Get& get)
{
  using Value = typename Array::ValueType;
  const auto array = NewLargeArray<Array>(features.ComponentOfTriangle.size());
  array->SetName(name);
  Value* values = array->GetPointer(0);
  ForRanges(executor, features.ComponentOfTriangle.size(),
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        values[t] = static_cast<Value>(get(features.ComponentOfTriangle[t]));
      }
    });
  polyData->GetCellData()->AddArray(array);
}

/** Add a member of the features of the components as cell data and as field data. */
template <typename CellArray, typename FieldArray, typename Value>
void AddFeature(vtkPolyData* polyData, const char* name, const SurfaceFeatures& features,
  Executor& executor, Value ComponentFeatures::*member)
{
  const auto get = [&](auto c, int = 0) { return features.Components[c].*member; };
  AddComponentCellArray<CellArray>(polyData, name, features, executor, get);
  AddComponentField<FieldArray, 1>(polyData, name, features.Components.size(), get);
}

/** Return the 98th percentile of the absolute residuals, 0 for none. Their order changes. */
double ResidualQuantile(LargeVector<float>& residuals)
{
  if (residuals.empty())
  {
    return 0.0;
  }
  const auto quantile = residuals.begin() +
    static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(residuals.size() - 1));
  std::nth_element(residuals.begin(), quantile, residuals.end(),
    [](float a, float b) { return std::abs(a) < std::abs(b); });
  return std::abs(*quantile);
}

/** Set the points, and free them. */
void SetPoints(vtkPolyData* polyData, LargeVector<Point>& positions, Executor& executor)
{
  vtkNew<vtkPoints> points;
  const auto coordinates = NewLargeArray<vtkDoubleArray>(positions.size(), 3);
  coordinates->SetName(points->GetData()->GetName());
  points->SetData(coordinates);
  double* to = coordinates->GetPointer(0);
  ForRanges(executor, positions.size(),
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        std::copy(positions[p].begin(), positions[p].end(), to + 3 * p);
      }
    });
  polyData->SetPoints(points);
  Free(positions);
}

/** Set the triangles, and free them. */
void SetTriangles(vtkPolyData* polyData, LargeVector<Triangle>& corners, Executor& executor)
{
  // vtkIdType is the type of VTK's own arrays, which readers of files may expect.
  const auto offsets = NewLargeArray<vtkIdTypeArray>(corners.size() + 1);
  const auto connectivity = NewLargeArray<vtkIdTypeArray>(3 * corners.size());
  vtkIdType* first = offsets->GetPointer(0);
  vtkIdType* to = connectivity->GetPointer(0);
  ForRanges(executor, corners.size(),
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        first[t] = static_cast<vtkIdType>(3 * t);
        std::copy(corners[t].begin(), corners[t].end(), to + 3 * t);
      }
    });
  first[corners.size()] = static_cast<vtkIdType>(3 * corners.size());
  Free(corners);
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets, connectivity);
  polyData->SetPolys(triangles);
}

int CountContacts(vtkPolyData* polyData)
{
  auto* contact = vtkUnsignedCharArray::SafeDownCast(polyData->GetPointData()->GetArray("Contact"));
  const unsigned char* values = contact->GetPointer(0);
  return static_cast<int>(std::count(values, values + contact->GetNumberOfValues(), 1));
}

/** Add the values as a point array of n entries. */
template <typename Array, typename T>
vtkSmartPointer<Array> AddPointArray(vtkPolyData* polyData, const char* name, std::size_t n,
  const LargeVector<T>& values, double factor = 1.0)
{
  const auto array = NewLargeArray<Array>(n);
  array->SetName(name);
  std::transform(values.begin(), values.end(), array->GetPointer(0),
    [factor](T value) { return static_cast<typename Array::ValueType>(factor * value); });
  polyData->GetPointData()->AddArray(array);
  return array;
}

/** Add all point arrays. Free those that are not needed later. */
void AddPointArrays(vtkPolyData* polyData, SurfaceResult& surface, const ComputationalSpace& space,
  Executor& executor)
{
  const std::size_t n = surface.Normals.size();
  const auto normals = NewLargeArray<vtkFloatArray>(n, 3);
  normals->SetName("Normals");
  float* to = normals->GetPointer(0);
  ForRanges(executor, n,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        const std::array<float, 3> normal = space.NormalToWorld(surface.Normals[p]);
        std::copy(normal.begin(), normal.end(), to + 3 * p);
      }
    });
  Free(surface.Normals);
  polyData->GetPointData()->SetNormals(normals);
  AddPointArray<vtkFloatArray>(polyData, "Residual", n, surface.Residual);
  AddPointArray<vtkUnsignedCharArray>(polyData, "Motionless", n, surface.Motionless);
  const auto contact = AddPointArray<vtkUnsignedCharArray>(polyData, "Contact", n, surface.Held);
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    for (const int p : pair)
    {
      contact->SetValue(p, 1);
    }
  }
  if (!surface.Size.empty())
  {
    AddPointArray<vtkFloatArray>(
      polyData, "EdgeSize", n, surface.Size, SizingField::RestLengthInDelta * space.WorldUnit());
  }
  if (!surface.Thickness.empty())
  {
    AddPointArray<vtkFloatArray>(polyData, "Thickness", n, surface.Thickness, space.WorldUnit());
  }
}

void SetFeatures(vtkPolyData* polyData, const SurfaceFeatures& features,
  const std::vector<int>& owners, Executor& executor)
{
  const auto& components = features.Components;
  const std::size_t n = components.size();
  AddFields(polyData,
    { { "NumberOfComponents", static_cast<int>(n) },
      { "EulerCharacteristic", features.EulerCharacteristic }, { "Genus", features.Genus },
      { "Area", features.Area }, { "Volume", features.Volume } });
  AddComponentCellArray<vtkIntArray>(
    polyData, "Component", features, executor, [](int c) { return c; });
  AddFeature<vtkFloatArray, vtkDoubleArray>(
    polyData, "ComponentArea", features, executor, &ComponentFeatures::Area);
  AddFeature<vtkFloatArray, vtkDoubleArray>(
    polyData, "ComponentVolume", features, executor, &ComponentFeatures::Volume);
  AddFeature<vtkIntArray, vtkIntArray>(
    polyData, "ComponentGenus", features, executor, &ComponentFeatures::Genus);
  AddComponentField<vtkIntArray, 1>(
    polyData, "ComponentOwner", n, [&](std::size_t c, int) { return owners[c]; });
  AddComponentField<vtkDoubleArray, 3>(polyData, "ComponentCentroid", n,
    [&](std::size_t c, int i) { return components[c].Centroid[i]; });
  AddComponentField<vtkDoubleArray, 6>(polyData, "ComponentInertia", n,
    [&](std::size_t c, int i) { return components[c].Inertia[i]; });
}
}

vtkSmartPointer<vtkPolyData> MakePolyData(SurfaceResult result,
  const SurfaceDescription& description, const ComputationalSpace& space,
  const ComponentChoice& choice, Executor& executor)
{
  auto polyData = vtkSmartPointer<vtkPolyData>::New();
  DescribedSurface described = DescribeSurface(std::move(result), space, choice, executor);
  SurfaceResult& surface = described.Shape;
  SetPoints(polyData, surface.Points, executor);
  SetTriangles(polyData, surface.Triangles, executor);
  AddPointArrays(polyData, surface, space, executor);
  HideArrays(polyData->GetPointData(), { "Motionless" });
  AddFields(polyData,
    { { "Level", description.Level }, { "StartLevel", description.StartLevel },
      { "Delta", surface.Delta * space.WorldUnit() }, { "Unit", description.Unit },
      { "Iterations", description.Iterations },
      { "RemainingContacts", static_cast<int>(surface.Contacts.size()) },
      { "ContactVertices", CountContacts(polyData) },
      { "ResidualQuantile", ResidualQuantile(surface.Residual) } });
  Free(surface.Residual);
  if (const auto& fit = surface.FitToTolerance)
  {
    AddFields(polyData,
      { { "LargestDistance", fit->LargestDistance * space.WorldUnit() },
        { "WithinTolerance", fit->WithinTolerance } });
  }
  const MissedParts& missed = description.Missed;
  AddFields(polyData,
    { { "LostParts", missed.Found }, { "RecoveredParts", missed.Enclosed },
      { "MissingParts", missed.Missing }, { "MissingBoundary", missed.MissingBoundary },
      { "LostCavities", missed.FoundCavities }, { "RecoveredCavities", missed.EnclosedCavities } });
  if (description.TotalIterations >= 0)
  {
    AddFields(polyData, { { "Iteration", description.TotalIterations } });
  }
  if (!description.StopReason.empty())
  {
    AddField<vtkStringArray>(
      polyData->GetFieldData(), "StopReason", description.StopReason.c_str());
  }
  SetFeatures(polyData, described.Features, described.Owners, executor);
  return polyData;
}

void HideArrays(vtkFieldData* arrays, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    arrays->GetArray(name)->GetInformation()->Set(vtkAbstractArray::GUI_HIDE(), 1);
  }
}

void SetStopReason(vtkPolyData* surface, const std::string& reason)
{
  // Do not modify field data that a shallow copy may share.
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(surface->GetFieldData());
  surface->SetFieldData(fieldData);
  AddField<vtkStringArray>(fieldData, "StopReason", reason.c_str());
}

vtkSmartPointer<vtkPolyData> MakeStopped(int level, const std::string& reason)
{
  SurfaceDescription description;
  description.Level = description.StartLevel = level;
  description.StopReason = reason;
  return MakePolyData(SurfaceResult(), description, ComputationalSpace());
}
}

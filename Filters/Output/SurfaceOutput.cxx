// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/SurfaceOutput.h"

#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "Host/LargeArrays.h"
#include "Input/Workspace.h"

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
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>
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

/** Calls body(begin, end) on ranges of n items, several of them at once. */
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

/** The same value for all triangles of a component, so that filters of cells can choose by it. */
template <typename Array, typename Get>
void AddComponentOfCells(vtkPolyData* polyData, const char* name, const SurfaceFeatures& features,
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
        const int component = features.ComponentOfTriangle[t];
        values[t] = static_cast<Value>(get(features.Components[component], component));
      }
    });
  polyData->GetCellData()->AddArray(array);
}

/** Sizes are in the order of their bits. */
std::uint32_t BitsOfSize(float value)
{
  value = std::abs(value);
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/** The size that 98 % of the residuals of the whole don't exceed; 0 for none. */
double ResidualQuantile(const LargeVector<float>& residuals)
{
  // Byte by byte, the first one first: how many have each, of those that have what is found so far.
  constexpr int bytes = 4;
  using Counts = std::array<std::int64_t, 256>;
  std::uint32_t found = 0;
  std::int64_t place = 0; // Among these, in order.
  for (int byte = bytes - 1; byte >= 0; --byte)
  {
    Counts counts{};
    for (const float residual : residuals)
    {
      const std::uint64_t bits = BitsOfSize(residual) >> (8 * byte);
      if (bits >> 8 == found)
      {
        ++counts[bits & 255];
      }
    }
    if (byte == bytes - 1)
    {
      const std::int64_t all = std::accumulate(counts.begin(), counts.end(), std::int64_t(0));
      if (all == 0)
      {
        return 0.0;
      }
      place = static_cast<std::int64_t>(0.98 * static_cast<double>(all - 1));
    }
    std::uint32_t next = 0;
    while (place >= counts[next])
    {
      place -= counts[next++];
    }
    found = found << 8 | next;
  }
  float size;
  std::memcpy(&size, &found, sizeof(size));
  return size;
}

void TakePoints(vtkPolyData* polyData, LargeVector<Point>& places, Executor& executor)
{
  vtkNew<vtkPoints> points;
  const auto coordinates = NewLargeArray<vtkDoubleArray>(places.size(), 3);
  coordinates->SetName(points->GetData()->GetName());
  points->SetData(coordinates);
  double* to = coordinates->GetPointer(0);
  ForRanges(executor, places.size(),
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t p = begin; p < end; ++p)
      {
        std::copy(places[p].begin(), places[p].end(), to + 3 * p);
      }
    });
  polyData->SetPoints(points);
  Free(places);
}

void TakeTriangles(vtkPolyData* polyData, LargeVector<Triangle>& corners, Executor& executor)
{
  // As VTK itself keeps them: what reads arrays of a file by their type finds the same.
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

/** Takes what the surface knows of its points, but for the residuals. */
void TakePointArrays(
  vtkPolyData* polyData, SurfaceResult& surface, const Workspace& space, Executor& executor)
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
  const auto residual = NewLargeArray<vtkFloatArray>(n);
  residual->SetName("Residual");
  std::copy(surface.Residual.begin(), surface.Residual.end(), residual->GetPointer(0));
  const auto motionless = NewLargeArray<vtkUnsignedCharArray>(n);
  motionless->SetName("Motionless");
  std::copy(surface.Motionless.begin(), surface.Motionless.end(), motionless->GetPointer(0));
  polyData->GetPointData()->SetNormals(normals);
  polyData->GetPointData()->AddArray(residual);
  polyData->GetPointData()->AddArray(motionless);
  const auto contact = NewLargeArray<vtkUnsignedCharArray>(n);
  contact->SetName("Contact");
  std::copy(surface.Held.begin(), surface.Held.end(), contact->GetPointer(0));
  for (const std::array<int, 2>& pair : surface.Contacts)
  {
    for (const int p : pair)
    {
      contact->SetValue(p, 1);
    }
  }
  polyData->GetPointData()->AddArray(contact);
  const auto addLengths = [&](const char* name, const LargeVector<float>& lengths, double factor)
  {
    if (!lengths.empty())
    {
      const auto array = NewLargeArray<vtkFloatArray>(n);
      array->SetName(name);
      std::transform(lengths.begin(), lengths.end(), array->GetPointer(0),
        [factor](float length) { return static_cast<float>(factor * length); });
      polyData->GetPointData()->AddArray(array);
    }
  };
  addLengths("EdgeSize", surface.Size, SizingField::RestLengthInDelta * space.WorldUnit());
  addLengths("Thickness", surface.Thickness, space.WorldUnit());
}

void SetFeatures(vtkPolyData* polyData, const SurfaceFeatures& features,
  const std::vector<int>& owners, Executor& executor)
{
  using Component = ComponentFeatures;
  AddComponentOfCells<vtkIntArray>(
    polyData, "Component", features, executor, [](const Component&, int c) { return c; });
  AddComponentOfCells<vtkFloatArray>(
    polyData, "ComponentArea", features, executor, [](const Component& c, int) { return c.Area; });
  AddComponentOfCells<vtkFloatArray>(polyData, "ComponentVolume", features, executor,
    [](const Component& c, int) { return c.Volume; });
  AddComponentOfCells<vtkIntArray>(polyData, "ComponentGenus", features, executor,
    [](const Component& c, int) { return c.Genus; });

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
  vtkNew<vtkIntArray> owner;
  owner->SetName("ComponentOwner");
  for (const int component : owners)
  {
    owner->InsertNextValue(component);
  }
  polyData->GetFieldData()->AddArray(owner);
  AddComponentField<vtkDoubleArray, 3>(polyData, "ComponentCentroid", features,
    [](const Component& c, int i) { return c.Centroid[i]; });
  AddComponentField<vtkDoubleArray, 6>(
    polyData, "ComponentInertia", features, [](const Component& c, int i) { return c.Inertia[i]; });
}

}

vtkSmartPointer<vtkPolyData> MakePolyData(SurfaceResult given,
  const SurfaceDescription& description, const Workspace& space, const ComponentChoice& choice,
  Executor& executor)
{
  auto polyData = vtkSmartPointer<vtkPolyData>::New();
  DescribedSurface described = DescribeSurface(std::move(given), space, choice, executor);
  SurfaceResult& surface = described.Shape;
  TakePoints(polyData, surface.Points, executor);
  TakeTriangles(polyData, surface.Triangles, executor);
  TakePointArrays(polyData, surface, space, executor);
  HideArrays(polyData->GetPointData(), { "Motionless" });
  AddField<vtkIntArray>(polyData, "Level", description.Level);
  AddField<vtkIntArray>(polyData, "StartLevel", description.StartLevel);
  AddField<vtkDoubleArray>(polyData, "Delta", surface.Delta * space.WorldUnit());
  AddField<vtkDoubleArray>(polyData, "Unit", description.Unit);
  AddField<vtkIntArray>(polyData, "Iterations", description.Iterations);
  AddField<vtkIntArray>(polyData, "RemainingContacts", static_cast<int>(surface.Contacts.size()));
  AddField<vtkIntArray>(polyData, "ContactVertices", CountContacts(polyData));
  AddField<vtkDoubleArray>(polyData, "ResidualQuantile", ResidualQuantile(surface.Residual));
  Free(surface.Residual);
  if (surface.FitToTolerance)
  {
    AddField<vtkDoubleArray>(
      polyData, "LargestDistance", surface.FitToTolerance->LargestDistance * space.WorldUnit());
    AddField<vtkDoubleArray>(polyData, "WithinTolerance", surface.FitToTolerance->WithinTolerance);
  }
  const LostParts& lost = description.Lost;
  AddField<vtkIntArray>(polyData, "LostParts", lost.Found);
  AddField<vtkIntArray>(polyData, "RecoveredParts", lost.Enclosed);
  AddField<vtkIntArray>(polyData, "MissingParts", lost.Missing);
  AddField<vtkDoubleArray>(polyData, "MissingBoundary", lost.MissingBoundary);
  AddField<vtkIntArray>(polyData, "LostCavities", lost.FoundCavities);
  AddField<vtkIntArray>(polyData, "RecoveredCavities", lost.EnclosedCavities);
  if (description.TotalIterations >= 0)
  {
    AddField<vtkIntArray>(polyData, "Iteration", description.TotalIterations);
  }
  if (!description.StopReason.empty())
  {
    AddField<vtkStringArray>(polyData, "StopReason", description.StopReason.c_str());
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
  // Not into field data that a shallow copy may share.
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(surface->GetFieldData());
  surface->SetFieldData(fieldData);
  AddField<vtkStringArray>(surface, "StopReason", reason.c_str());
}

vtkSmartPointer<vtkPolyData> MakeStopped(int level, const std::string& reason)
{
  SurfaceDescription description;
  description.Level = description.StartLevel = level;
  description.StopReason = reason;
  return MakePolyData(SurfaceResult(), description, Workspace());
}
}

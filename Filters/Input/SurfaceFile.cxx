// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/SurfaceFile.h"

#include "Input/InputPoints.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkType.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace volumic
{
namespace
{
std::size_t BytesOf(vtkDataArray* array)
{
  return static_cast<std::size_t>(array->GetNumberOfValues()) *
    static_cast<std::size_t>(array->GetDataTypeSize());
}

void WriteArray(CheckedWriter& file, vtkAbstractArray* array)
{
  file.PutText(array->GetName() ? array->GetName() : "");
  file.Put<std::int32_t>(array->GetDataType());
  file.Put<std::int32_t>(array->GetNumberOfComponents());
  file.Put<std::int64_t>(array->GetNumberOfTuples());
  if (auto* texts = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
    {
      file.PutText(texts->GetValue(i));
    }
  }
  else if (auto* numbers = vtkDataArray::SafeDownCast(array))
  {
    file.Write(numbers->GetVoidPointer(0), BytesOf(numbers));
  }
}

vtkSmartPointer<vtkAbstractArray> ReadArray(CheckedReader& file)
{
  const std::string name = file.GetText();
  const auto type = file.Get<std::int32_t>();
  if (type == VTK_BIT || (type != VTK_STRING && vtkDataArray::GetDataTypeSize(type) == 0))
  {
    file.Refuse("is damaged");
  }
  auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  if (!name.empty())
  {
    array->SetName(name.c_str());
  }
  const auto components = file.Get<std::int32_t>();
  file.Need(static_cast<std::uint32_t>(components), 1);
  array->SetNumberOfComponents(std::max(components, 1));
  const auto tuples = file.Get<std::int64_t>();
  // Each text has its length.
  const std::size_t least =
    array->IsNumeric() ? static_cast<std::size_t>(array->GetDataTypeSize()) : sizeof(std::uint64_t);
  file.Need(static_cast<std::uint64_t>(tuples),
    std::max<std::size_t>(least, 1) * static_cast<std::size_t>(array->GetNumberOfComponents()));
  array->SetNumberOfTuples(tuples);
  if (auto* texts = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
    {
      texts->SetValue(i, file.GetText());
    }
  }
  else if (auto* numbers = vtkDataArray::SafeDownCast(array))
  {
    file.Read(numbers->GetVoidPointer(0), BytesOf(numbers));
  }
  return array;
}

void WriteArrays(CheckedWriter& file, vtkFieldData* arrays)
{
  file.Put<std::int32_t>(arrays->GetNumberOfArrays());
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    WriteArray(file, arrays->GetAbstractArray(i));
  }
}

void ReadArrays(CheckedReader& file, vtkFieldData* arrays)
{
  const auto count = file.Get<std::int32_t>();
  for (int i = 0; i < count; ++i)
  {
    arrays->AddArray(ReadArray(file));
  }
}

vtkSmartPointer<vtkDataArray> ReadNumbers(CheckedReader& file, int components)
{
  const vtkSmartPointer<vtkDataArray> numbers = vtkDataArray::SafeDownCast(ReadArray(file));
  if (!numbers || numbers->GetNumberOfComponents() != components)
  {
    file.Refuse("is damaged");
  }
  return numbers;
}
}

void WriteSurfaceTo(CheckedWriter& file, vtkPolyData* surface)
{
  WriteArray(file, surface->GetPoints()->GetData());
  WriteArray(file, surface->GetPolys()->GetOffsetsArray());
  WriteArray(file, surface->GetPolys()->GetConnectivityArray());
  WriteArrays(file, surface->GetPointData());
  WriteArrays(file, surface->GetCellData());
  WriteArrays(file, surface->GetFieldData());
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  file.PutText(normals ? normals->GetName() : "");
}

vtkSmartPointer<vtkPolyData> ReadSurfaceFrom(CheckedReader& file)
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ReadNumbers(file, 3));
  surface->SetPoints(points);
  const vtkSmartPointer<vtkDataArray> offsets = ReadNumbers(file, 1);
  const vtkSmartPointer<vtkDataArray> connectivity = ReadNumbers(file, 1);
  vtkNew<vtkCellArray> triangles;
  const bool areCells = triangles->SetData(offsets, connectivity);
  surface->SetPolys(triangles);
  ReadArrays(file, surface->GetPointData());
  ReadArrays(file, surface->GetCellData());
  ReadArrays(file, surface->GetFieldData());
  // The signature of a file shows no damage, but whoever made it can sign anything.
  const auto areAsMany = [](vtkFieldData* arrays, vtkIdType count)
  {
    bool areSo = true;
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      areSo = areSo && arrays->GetAbstractArray(i)->GetNumberOfTuples() == count;
    }
    return areSo;
  };
  const vtkIdType corners = areCells ? triangles->IsHomogeneous() : -1;
  if ((corners != 0 && corners != 3) || !FaultOfCells(surface).empty() ||
    !areAsMany(surface->GetPointData(), points->GetNumberOfPoints()) ||
    !areAsMany(surface->GetCellData(), triangles->GetNumberOfCells()))
  {
    file.Refuse("is damaged: what it holds is no surface");
  }
  surface->GetPointData()->SetActiveNormals(file.GetText().c_str());
  return surface;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/SurfaceFile.h"

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
  auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  if (!name.empty())
  {
    array->SetName(name.c_str());
  }
  array->SetNumberOfComponents(file.Get<std::int32_t>());
  const auto tuples = file.Get<std::int64_t>();
  // Each text has its length.
  const std::size_t least = array->IsNumeric() ? static_cast<std::size_t>(array->GetDataTypeSize())
                                               : sizeof(std::uint64_t);
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

vtkSmartPointer<vtkDataArray> ReadNumbers(CheckedReader& file)
{
  return vtkDataArray::SafeDownCast(ReadArray(file));
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
  points->SetData(ReadNumbers(file));
  surface->SetPoints(points);
  const vtkSmartPointer<vtkDataArray> offsets = ReadNumbers(file);
  const vtkSmartPointer<vtkDataArray> connectivity = ReadNumbers(file);
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets, connectivity);
  surface->SetPolys(triangles);
  ReadArrays(file, surface->GetPointData());
  ReadArrays(file, surface->GetCellData());
  ReadArrays(file, surface->GetFieldData());
  surface->GetPointData()->SetActiveNormals(file.GetText().c_str());
  return surface;
}
}

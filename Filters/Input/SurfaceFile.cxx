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
#include <stdexcept>
#include <string>
#include <utility>

namespace volumic
{
namespace
{
std::size_t BytesOf(vtkDataArray* array)
{
  return static_cast<std::size_t>(array->GetNumberOfValues()) *
    static_cast<std::size_t>(array->GetDataTypeSize());
}

/** Writes into a message as CheckedWriter does into a file. */
class MessageFile
{
public:
  void Write(const void* bytes, std::size_t count)
  {
    const char* begin = static_cast<const char*>(bytes);
    this->Content.insert(this->Content.end(), begin, begin + count);
  }
  template <typename T>
  void Put(const T& value)
  {
    this->Write(&value, sizeof(T));
  }
  void PutText(const std::string& text)
  {
    this->Put<std::uint64_t>(text.size());
    this->Write(text.data(), text.size());
  }

  Message Content;
};

/** Reads that again. */
class ReadMessageFile
{
public:
  explicit ReadMessageFile(const Message& content)
    : Content(content)
  {
  }
  void Read(void* bytes, std::size_t count)
  {
    this->Need(count, 1);
    std::copy_n(this->Content.data() + this->Place, count, static_cast<char*>(bytes));
    this->Place += count;
  }
  template <typename T>
  T Get()
  {
    T value;
    this->Read(&value, sizeof(T));
    return value;
  }
  void Need(std::uint64_t count, std::size_t bytes) const
  {
    if (count > (this->Content.size() - this->Place) / bytes)
    {
      throw std::logic_error("A message of another process is shorter than expected.");
    }
  }
  std::string GetText()
  {
    const auto count = this->Get<std::uint64_t>();
    this->Need(count, 1);
    std::string text(count, ' ');
    this->Read(text.data(), text.size());
    return text;
  }

private:
  const Message& Content;
  std::size_t Place = 0;
};

template <typename File>
void WriteArray(File& file, vtkAbstractArray* array)
{
  file.PutText(array->GetName() ? array->GetName() : "");
  file.template Put<std::int32_t>(array->GetDataType());
  file.template Put<std::int32_t>(array->GetNumberOfComponents());
  file.template Put<std::int64_t>(array->GetNumberOfTuples());
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

template <typename File>
vtkSmartPointer<vtkAbstractArray> ReadArray(File& file)
{
  const std::string name = file.GetText();
  const auto type = file.template Get<std::int32_t>();
  auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  if (!name.empty())
  {
    array->SetName(name.c_str());
  }
  array->SetNumberOfComponents(file.template Get<std::int32_t>());
  const auto tuples = file.template Get<std::int64_t>();
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

template <typename File>
void WriteArrays(File& file, vtkFieldData* arrays)
{
  file.template Put<std::int32_t>(arrays->GetNumberOfArrays());
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    WriteArray(file, arrays->GetAbstractArray(i));
  }
}

template <typename File>
void ReadArrays(File& file, vtkFieldData* arrays)
{
  const auto count = file.template Get<std::int32_t>();
  for (int i = 0; i < count; ++i)
  {
    arrays->AddArray(ReadArray(file));
  }
}

template <typename File>
vtkSmartPointer<vtkDataArray> ReadNumbers(File& file)
{
  return vtkDataArray::SafeDownCast(ReadArray(file));
}

template <typename File>
void Write(File& file, vtkPolyData* surface)
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

template <typename File>
vtkSmartPointer<vtkPolyData> Read(File& file)
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
}}

void WriteSurfaceTo(CheckedWriter& file, vtkPolyData* surface)
{
  Write(file, surface);
}

vtkSmartPointer<vtkPolyData> ReadSurfaceFrom(CheckedReader& file)
{
  return Read(file);
}

Message MessageOf(vtkPolyData* surface)
{
  MessageFile file;
  Write(file, surface);
  for (vtkCellArray* cells : { surface->GetVerts(), surface->GetLines(), surface->GetStrips() })
  {
    WriteArray(file, cells->GetOffsetsArray());
    WriteArray(file, cells->GetConnectivityArray());
  }
  vtkDataArray* ids = surface->GetPointData()->GetGlobalIds();
  file.PutText(ids ? ids->GetName() : "");
  return std::move(file.Content);
}

vtkSmartPointer<vtkPolyData> SurfaceFrom(const Message& message)
{
  ReadMessageFile file(message);
  vtkSmartPointer<vtkPolyData> surface = Read(file);
  const auto readCells = [&file]
  {
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    const vtkSmartPointer<vtkDataArray> offsets = ReadNumbers(file);
    cells->SetData(offsets, ReadNumbers(file));
    return cells;
  };
  surface->SetVerts(readCells());
  surface->SetLines(readCells());
  surface->SetStrips(readCells());
  surface->GetPointData()->SetActiveGlobalIds(file.GetText().c_str());
  return surface;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankMessage.h"

#include "Input/ImageVoxels.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTypes.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

namespace volumic
{
namespace
{
/** No tag of VTK or ParaView: they count from 1, and from 100, 8000 and 99990. */
constexpr int Tag = 22095;

/** What has arrays beside the field data. */
constexpr int Associations[] = { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW };

void Check(bool isThrough)
{
  if (!isThrough)
  {
    throw std::runtime_error("A message to or of another process has failed.");
  }
}

std::string TextOf(const char* text)
{
  return text ? text : "";
}

std::size_t BytesOf(vtkDataArray* array)
{
  return static_cast<std::size_t>(array->GetNumberOfValues()) *
    static_cast<std::size_t>(array->GetDataTypeSize());
}

/** Of numbers or texts; others stay behind. */
void PutArray(RankMessage& message, vtkAbstractArray* array)
{
  auto* texts = vtkStringArray::SafeDownCast(array);
  vtkSmartPointer<vtkDataArray> numbers = vtkDataArray::SafeDownCast(array);
  numbers = numbers ? ContiguousVoxels(numbers) : nullptr;
  message << (numbers ? numbers->GetDataType() : texts ? VTK_STRING : VTK_VOID)
          << TextOf(array->GetName()) << array->GetNumberOfComponents()
          << array->GetNumberOfTuples();
  if (numbers)
  {
    message.PutBytes(numbers->GetVoidPointer(0), BytesOf(numbers));
  }
  for (vtkIdType i = 0; texts && i < texts->GetNumberOfValues(); ++i)
  {
    message << static_cast<const std::string&>(texts->GetValue(i));
  }
}

vtkSmartPointer<vtkAbstractArray> TakeArray(RankMessage& message)
{
  int type = VTK_VOID;
  std::string name;
  int components = 1;
  vtkIdType tuples = 0;
  message >> type >> name >> components >> tuples;
  if (type == VTK_VOID)
  {
    return nullptr;
  }
  const auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  array->SetName(name.empty() ? nullptr : name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  if (auto* numbers = vtkDataArray::SafeDownCast(array))
  {
    message.TakeBytes(numbers->GetVoidPointer(0), BytesOf(numbers));
    return array;
  }
  auto* texts = vtkStringArray::SafeDownCast(array);
  for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
  {
    std::string text;
    message >> text;
    texts->SetValue(i, text);
  }
  return array;
}

vtkSmartPointer<vtkDataArray> TakeNumbers(RankMessage& message)
{
  return vtkDataArray::SafeDownCast(TakeArray(message));
}

void PutArrays(RankMessage& message, vtkFieldData* arrays)
{
  auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
  message << arrays->GetNumberOfArrays();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    PutArray(message, arrays->GetAbstractArray(i));
    message << (attributes ? attributes->IsArrayAnAttribute(i) : -1);
  }
}

void TakeArrays(RankMessage& message, vtkFieldData* arrays)
{
  auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
  int count = 0;
  message >> count;
  for (int i = 0; i < count; ++i)
  {
    const vtkSmartPointer<vtkAbstractArray> array = TakeArray(message);
    int attribute = -1;
    message >> attribute;
    const int place = array ? arrays->AddArray(array) : -1;
    if (attributes && place >= 0 && attribute >= 0)
    {
      attributes->SetActiveAttribute(place, attribute);
    }
  }
}

void PutShape(RankMessage& message, vtkPolyData* surface)
{
  vtkNew<vtkPoints> none;
  PutArray(message, (surface->GetPoints() ? surface->GetPoints() : none.Get())->GetData());
  for (vtkCellArray* cells :
    { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
  {
    PutArray(message, cells->GetOffsetsArray());
    PutArray(message, cells->GetConnectivityArray());
  }
}

void TakeShape(RankMessage& message, vtkPolyData* surface)
{
  vtkNew<vtkPoints> points;
  points->SetData(TakeNumbers(message));
  surface->SetPoints(points);
  const auto take = [&message]
  {
    const vtkSmartPointer<vtkDataArray> offsets = TakeNumbers(message);
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(offsets, TakeNumbers(message));
    return cells;
  };
  surface->SetVerts(take());
  surface->SetLines(take());
  surface->SetPolys(take());
  surface->SetStrips(take());
}

void PutShape(RankMessage& message, vtkImageData* image)
{
  message.PutBytes(image->GetExtent(), 6 * sizeof(int));
  message.PutBytes(image->GetOrigin(), 3 * sizeof(double));
  message.PutBytes(image->GetSpacing(), 3 * sizeof(double));
  message.PutBytes(image->GetDirectionMatrix()->GetData(), 9 * sizeof(double));
}

void TakeShape(RankMessage& message, vtkImageData* image)
{
  std::array<int, 6> extent;
  std::array<double, 15> numbers;
  message >> extent >> numbers;
  image->SetExtent(extent.data());
  image->SetOrigin(numbers.data());
  image->SetSpacing(numbers.data() + 3);
  image->SetDirectionMatrix(numbers.data() + 6);
}

void PutShape(RankMessage& message, vtkMultiBlockDataSet* blocks)
{
  message << blocks->GetNumberOfBlocks();
  for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
  {
    message << TextOf(
      blocks->HasMetaData(b) ? blocks->GetMetaData(b)->Get(vtkCompositeDataSet::NAME()) : nullptr);
    message.Put(blocks->GetBlock(b));
  }
}

void TakeShape(RankMessage& message, vtkMultiBlockDataSet* blocks)
{
  unsigned int count = 0;
  message >> count;
  for (unsigned int b = 0; b < count; ++b)
  {
    std::string name;
    message >> name;
    blocks->SetBlock(b, message.TakeData());
    blocks->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), name.c_str());
  }
}

/** Does something with the data as what they are. @return whether messages know that */
template <typename Do>
bool WithType(vtkDataObject* data, const Do& work)
{
  auto* surface = vtkPolyData::SafeDownCast(data);
  auto* image = vtkImageData::SafeDownCast(data);
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data);
  surface ? work(surface) : image ? work(image) : blocks ? work(blocks) : void();
  return surface || image || blocks || vtkTable::SafeDownCast(data);
}

/** Does something with all arrays of the data. */
template <typename Do>
void ForArraysOf(vtkDataObject* data, const Do& work)
{
  work(data->GetFieldData());
  for (const int type : Associations)
  {
    if (vtkDataSetAttributes* attributes = data->GetAttributes(type))
    {
      work(attributes);
    }
  }
}
}

void RankMessage::PutBytes(const void* bytes, std::size_t count)
{
  const std::size_t before = this->Bytes.size();
  this->Bytes.resize(before + count);
  if (count > 0)
  {
    std::memcpy(this->Bytes.data() + before, bytes, count);
  }
}

void RankMessage::TakeBytes(void* bytes, std::size_t count)
{
  Check(count <= this->Bytes.size() - this->Taken);
  if (count > 0)
  {
    std::memcpy(bytes, this->Bytes.data() + this->Taken, count);
  }
  this->Taken += count;
}

void RankMessage::Put(vtkDataObject* data)
{
  const bool isKnown = WithType(data, [](auto*) {});
  *this << (isKnown ? data->GetDataObjectType() : -1);
  if (isKnown)
  {
    ForArraysOf(data, [this](vtkFieldData* arrays) { PutArrays(*this, arrays); });
    WithType(data, [this](auto* known) { PutShape(*this, known); });
  }
}

vtkSmartPointer<vtkDataObject> RankMessage::TakeData()
{
  int type = -1;
  *this >> type;
  if (type < 0)
  {
    return nullptr;
  }
  const auto data = vtkSmartPointer<vtkDataObject>::Take(vtkDataObjectTypes::NewDataObject(type));
  ForArraysOf(data, [this](vtkFieldData* arrays) { TakeArrays(*this, arrays); });
  WithType(data, [this](auto* known) { TakeShape(*this, known); });
  return data;
}

void RankMessage::Send(vtkMultiProcessController* controller, int to, int word) const
{
  const auto size = static_cast<vtkIdType>(this->Bytes.size());
  const vtkIdType head[] = { word, size };
  Check(controller->Send(head, 2, to, Tag) != 0 &&
    (size == 0 || controller->Send(this->Bytes.data(), size, to, Tag) != 0));
}

int RankMessage::Receive(vtkMultiProcessController* controller, int from)
{
  vtkIdType head[] = { 0, 0 };
  Check(controller->Receive(head, 2, from, Tag) != 0);
  this->Bytes.resize(static_cast<std::size_t>(head[1]));
  Check(head[1] == 0 || controller->Receive(this->Bytes.data(), head[1], from, Tag) != 0);
  return static_cast<int>(head[0]);
}
}

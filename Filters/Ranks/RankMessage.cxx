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

#include <algorithm>
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

/** An array of numbers or texts; others stay behind. */
void PassArray(RankMessage& message, vtkSmartPointer<vtkAbstractArray>& array)
{
  vtkSmartPointer<vtkDataArray> numbers = vtkDataArray::SafeDownCast(array);
  numbers = numbers ? ContiguousVoxels(numbers) : nullptr;
  const bool isKnown = numbers || vtkStringArray::SafeDownCast(array);
  int type = numbers ? numbers->GetDataType() : isKnown ? VTK_STRING : VTK_VOID;
  std::string name = TextOf(isKnown ? array->GetName() : nullptr);
  int components = isKnown ? array->GetNumberOfComponents() : 1;
  vtkIdType tuples = isKnown ? array->GetNumberOfTuples() : 0;
  message& type& name& components& tuples;
  if (message.IsReceived() && type != VTK_VOID)
  {
    array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
    array->SetName(name.empty() ? nullptr : name.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    numbers = vtkDataArray::SafeDownCast(array);
  }
  if (numbers)
  {
    message.Pass(numbers->GetVoidPointer(0),
      static_cast<std::size_t>(numbers->GetNumberOfValues() * numbers->GetDataTypeSize()));
  }
  auto* texts = vtkStringArray::SafeDownCast(array);
  for (vtkIdType i = 0; texts && i < texts->GetNumberOfValues(); ++i)
  {
    message& static_cast<std::string&>(texts->GetValue(i));
  }
}

/** Likewise; another one in its place. */
vtkSmartPointer<vtkDataArray> PassNumbers(RankMessage& message, vtkDataArray* given)
{
  vtkSmartPointer<vtkAbstractArray> array = given;
  PassArray(message, array);
  return vtkDataArray::SafeDownCast(array);
}

void PassArrays(RankMessage& message, vtkFieldData* arrays)
{
  auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
  int count = arrays->GetNumberOfArrays();
  message& count;
  for (int i = 0; i < count; ++i)
  {
    vtkSmartPointer<vtkAbstractArray> array = arrays->GetAbstractArray(i);
    int attribute = attributes && array ? attributes->IsArrayAnAttribute(i) : -1;
    PassArray(message, array);
    message& attribute;
    const int place = message.IsReceived() && array ? arrays->AddArray(array) : -1;
    if (place >= 0 && attribute >= 0)
    {
      attributes->SetActiveAttribute(place, attribute);
    }
  }
}

void PassShape(RankMessage& message, vtkPolyData* surface)
{
  vtkNew<vtkPoints> points;
  vtkPoints* given = surface->GetPoints();
  points->SetData(PassNumbers(message, (given ? given : points.Get())->GetData()));
  const auto pass = [&message](vtkCellArray* of)
  {
    const vtkSmartPointer<vtkDataArray> offsets = PassNumbers(message, of->GetOffsetsArray());
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(offsets, PassNumbers(message, of->GetConnectivityArray()));
    return cells;
  };
  const auto verts = pass(surface->GetVerts());
  const auto lines = pass(surface->GetLines());
  const auto polys = pass(surface->GetPolys());
  const auto strips = pass(surface->GetStrips());
  if (message.IsReceived())
  {
    surface->SetPoints(points);
    surface->SetVerts(verts);
    surface->SetLines(lines);
    surface->SetPolys(polys);
    surface->SetStrips(strips);
  }
}

void PassShape(RankMessage& message, vtkImageData* image)
{
  std::array<int, 6> extent;
  std::array<double, 3> origin;
  std::array<double, 3> spacing;
  std::array<double, 9> direction;
  image->GetExtent(extent.data());
  image->GetOrigin(origin.data());
  image->GetSpacing(spacing.data());
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, direction.begin());
  message& extent& origin& spacing& direction;
  if (message.IsReceived())
  {
    image->SetExtent(extent.data());
    image->SetOrigin(origin.data());
    image->SetSpacing(spacing.data());
    image->SetDirectionMatrix(direction.data());
  }
}

void PassShape(RankMessage& message, vtkMultiBlockDataSet* blocks)
{
  unsigned int count = blocks->GetNumberOfBlocks();
  message& count;
  for (unsigned int b = 0; b < count; ++b)
  {
    std::string name = TextOf(
      blocks->HasMetaData(b) ? blocks->GetMetaData(b)->Get(vtkCompositeDataSet::NAME()) : nullptr);
    message& name;
    if (message.IsReceived())
    {
      blocks->SetBlock(b, message.TakeData());
      blocks->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), name.c_str());
    }
    else
    {
      message.Put(blocks->GetBlock(b));
    }
  }
}

/** All that the data have. */
void PassContents(RankMessage& message, vtkDataObject* data)
{
  PassArrays(message, data->GetFieldData());
  for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW })
  {
    if (vtkDataSetAttributes* attributes = data->GetAttributes(type))
    {
      PassArrays(message, attributes);
    }
  }
  if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    PassShape(message, surface);
  }
  else if (auto* image = vtkImageData::SafeDownCast(data))
  {
    PassShape(message, image);
  }
  else if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
  {
    PassShape(message, blocks);
  }
}
}

void RankMessage::Pass(void* bytes, std::size_t count)
{
  if (!this->WasReceived)
  {
    this->Taken = this->Bytes.size();
    this->Bytes.resize(this->Taken + count);
  }
  Check(count <= this->Bytes.size() - this->Taken);
  if (count > 0)
  {
    char* here = this->Bytes.data() + this->Taken;
    this->WasReceived ? std::memcpy(bytes, here, count) : std::memcpy(here, bytes, count);
  }
  this->Taken += count;
}

void RankMessage::Put(vtkDataObject* data)
{
  const bool isKnown = vtkPolyData::SafeDownCast(data) || vtkImageData::SafeDownCast(data) ||
    vtkMultiBlockDataSet::SafeDownCast(data) || vtkTable::SafeDownCast(data);
  *this << (isKnown ? data->GetDataObjectType() : -1);
  if (isKnown)
  {
    PassContents(*this, data);
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
  PassContents(*this, data);
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
  this->WasReceived = true;
  return static_cast<int>(head[0]);
}
}

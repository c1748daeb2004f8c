// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankMessage.h"

#include "Input/ImageVoxels.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCompositeDataSet.h>
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
#include <cstddef>
#include <stdexcept>
#include <string>

namespace volumic
{
namespace
{
/** What has arrays beside the field data. */
constexpr int Associations[] = { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW };

void Check(bool isThrough)
{
  if (!isThrough)
  {
    throw std::runtime_error("A message to or of another process has failed.");
  }
}

std::string NameIn(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

void PutTexts(RankMessage& message, vtkStringArray* texts)
{
  message.Words << NameIn(texts) << texts->GetNumberOfComponents()
                << static_cast<vtkTypeInt64>(texts->GetNumberOfTuples());
  for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
  {
    message.Words << texts->GetValue(i);
  }
}

vtkSmartPointer<vtkStringArray> TakeTexts(RankMessage& message)
{
  std::string name;
  int components = 1;
  vtkTypeInt64 tuples = 0;
  message.Words >> name >> components >> tuples;
  auto texts = vtkSmartPointer<vtkStringArray>::New();
  texts->SetName(name.c_str());
  texts->SetNumberOfComponents(components);
  texts->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
  {
    std::string text;
    message.Words >> text;
    texts->SetValue(i, text);
  }
  return texts;
}
}

void RankMessage::Put(vtkDataArray* array)
{
  this->Arrays.emplace_back(ContiguousVoxels(array));
}

vtkSmartPointer<vtkDataArray> RankMessage::TakeArray()
{
  return this->Arrays.at(this->Taken++);
}

void RankMessage::PutArrays(vtkFieldData* arrays)
{
  auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
  this->Words << arrays->GetNumberOfArrays();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    auto* numbers = vtkDataArray::SafeDownCast(arrays->GetAbstractArray(i));
    auto* texts = vtkStringArray::SafeDownCast(arrays->GetAbstractArray(i));
    this->Words << (numbers != nullptr) << (texts != nullptr)
                << (attributes ? attributes->IsArrayAnAttribute(i) : -1);
    if (numbers)
    {
      this->Put(numbers);
    }
    else if (texts)
    {
      PutTexts(*this, texts);
    }
  }
}

void RankMessage::TakeInto(vtkFieldData* arrays)
{
  auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays);
  int count = 0;
  this->Words >> count;
  for (int i = 0; i < count; ++i)
  {
    bool areNumbers = false;
    bool areTexts = false;
    int attribute = -1;
    this->Words >> areNumbers >> areTexts >> attribute;
    if (!areNumbers && !areTexts)
    {
      continue;
    }
    const int place =
      areNumbers ? arrays->AddArray(this->TakeArray()) : arrays->AddArray(TakeTexts(*this));
    if (attributes && attribute >= 0)
    {
      attributes->SetActiveAttribute(place, attribute);
    }
  }
}

void RankMessage::Put(vtkDataObject* data)
{
  auto* surface = vtkPolyData::SafeDownCast(data);
  auto* image = vtkImageData::SafeDownCast(data);
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data);
  const bool isKnown = surface || image || blocks || vtkTable::SafeDownCast(data);
  this->Words << (isKnown ? data->GetDataObjectType() : -1);
  if (!isKnown)
  {
    return;
  }
  this->PutArrays(data->GetFieldData());
  for (const int type : Associations)
  {
    if (vtkDataSetAttributes* attributes = data->GetAttributes(type))
    {
      this->PutArrays(attributes);
    }
  }
  if (surface)
  {
    this->Words << (surface->GetPoints() != nullptr);
    if (surface->GetPoints())
    {
      this->Put(surface->GetPoints()->GetData());
    }
    for (vtkCellArray* cells :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      this->Put(cells->GetOffsetsArray());
      this->Put(cells->GetConnectivityArray());
    }
  }
  else if (image)
  {
    PutPlace(*this, PlaceOf(image));
  }
  else if (blocks)
  {
    this->Words << static_cast<int>(blocks->GetNumberOfBlocks());
    for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
    {
      const char* name =
        blocks->HasMetaData(b) ? blocks->GetMetaData(b)->Get(vtkCompositeDataSet::NAME()) : nullptr;
      this->Words << std::string(name ? name : "");
      this->Put(blocks->GetBlock(b));
    }
  }
}

vtkSmartPointer<vtkDataObject> RankMessage::TakeData()
{
  int type = -1;
  this->Words >> type;
  if (type < 0)
  {
    return nullptr;
  }
  const auto data = vtkSmartPointer<vtkDataObject>::Take(vtkDataObjectTypes::NewDataObject(type));
  this->TakeInto(data->GetFieldData());
  for (const int association : Associations)
  {
    if (vtkDataSetAttributes* attributes = data->GetAttributes(association))
    {
      this->TakeInto(attributes);
    }
  }
  if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    this->TakeShape(surface);
  }
  else if (auto* image = vtkImageData::SafeDownCast(data))
  {
    Place place = TakePlace(*this);
    image->SetExtent(place.Extent.data());
    image->SetOrigin(place.Origin.data());
    image->SetSpacing(place.Spacing.data());
    image->SetDirectionMatrix(place.Direction.data());
  }
  else if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
  {
    int count = 0;
    this->Words >> count;
    for (unsigned int b = 0; b < static_cast<unsigned int>(count); ++b)
    {
      std::string name;
      this->Words >> name;
      blocks->SetBlock(b, this->TakeData());
      blocks->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), name.c_str());
    }
  }
  return data;
}

void RankMessage::TakeShape(vtkPolyData* surface)
{
  bool hasPoints = false;
  this->Words >> hasPoints;
  if (hasPoints)
  {
    vtkNew<vtkPoints> points;
    points->SetData(this->TakeArray());
    surface->SetPoints(points);
  }
  const auto take = [this]
  {
    const vtkSmartPointer<vtkDataArray> offsets = this->TakeArray();
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(offsets, this->TakeArray());
    return cells;
  };
  surface->SetVerts(take());
  surface->SetLines(take());
  surface->SetPolys(take());
  surface->SetStrips(take());
}

void RankMessage::Send(vtkMultiProcessController* controller, int to, int tag) const
{
  vtkMultiProcessStream head;
  head << static_cast<int>(this->Arrays.size());
  for (vtkDataArray* array : this->Arrays)
  {
    head << array->GetDataType();
  }
  Check(controller->Send(head, to, tag) != 0);
  Check(controller->Send(this->Words, to, tag) != 0);
  for (vtkDataArray* array : this->Arrays)
  {
    Check(controller->Send(array, to, tag) != 0);
  }
}

void RankMessage::Receive(vtkMultiProcessController* controller, int from, int tag)
{
  vtkMultiProcessStream head;
  Check(controller->Receive(head, from, tag) != 0);
  int count = 0;
  head >> count;
  for (int i = 0; i < count; ++i)
  {
    int type = 0;
    head >> type;
    this->Arrays.push_back(
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type)));
  }
  Check(controller->Receive(this->Words, from, tag) != 0);
  for (vtkDataArray* array : this->Arrays)
  {
    Check(controller->Receive(array, from, tag) != 0);
  }
}

Place PlaceOf(vtkImageData* image)
{
  Place place;
  if (image && image->GetNumberOfPoints() > 0)
  {
    image->GetExtent(place.Extent.data());
    image->GetOrigin(place.Origin.data());
    image->GetSpacing(place.Spacing.data());
    std::copy_n(image->GetDirectionMatrix()->GetData(), 9, place.Direction.begin());
  }
  return place;
}

namespace
{
/** What there is to do with all numbers of a place. */
template <typename PlaceType, typename Visit>
void ForNumbersOf(PlaceType& place, const Visit& visit)
{
  std::for_each(place.Extent.begin(), place.Extent.end(), visit);
  std::for_each(place.Origin.begin(), place.Origin.end(), visit);
  std::for_each(place.Spacing.begin(), place.Spacing.end(), visit);
  std::for_each(place.Direction.begin(), place.Direction.end(), visit);
}
}

void PutPlace(RankMessage& message, const Place& place)
{
  ForNumbersOf(place, [&message](auto number) { message.Words << number; });
}

Place TakePlace(RankMessage& message)
{
  Place place;
  ForNumbersOf(place, [&message](auto& number) { message.Words >> number; });
  return place;
}
}

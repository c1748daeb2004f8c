// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumePart.h"

#include "Messages.h"
#include "Ranks.h"
#include "ReadVolume.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLReader.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <type_traits>
#include <vector>

namespace tool
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
constexpr int Points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
/** Bytes up to which a .vti is read whole. */
constexpr double SmallVolume = 32 << 20;

bool IsEmpty(const int* extent)
{
  return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
}
}

vtkStandardNewMacro(VolumePart);

vtkInformation* VoxelsIn(vtkInformation* info, const std::string& array)
{
  return array.empty()
    ? vtkDataObject::GetActiveFieldInformation(info, Points, vtkDataSetAttributes::SCALARS)
    : vtkDataObject::GetNamedFieldInformation(info, Points, array.c_str());
}

int ComponentsIn(vtkInformation* voxels)
{
  const bool isCounted = voxels && voxels->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
  return isCounted ? voxels->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) : 1;
}

std::array<int, 3> VolumeFacts::Size() const
{
  const auto& e = this->Extent;
  return { e[1] - e[0] + 1, e[3] - e[2] + 1, e[5] - e[4] + 1 };
}

VolumeFacts FactsOf(vtkImageData* image, vtkDataArray* scalars, int component)
{
  VolumeFacts facts;
  image->GetExtent(facts.Extent.data());
  image->GetSpacing(facts.Spacing.data());
  image->GetOrigin(facts.Origin.data());
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, facts.Direction.begin());
  facts.Type = scalars->GetDataType();
  facts.Components = scalars->GetNumberOfComponents();
  facts.Range = RangeOf(scalars, component);
  return facts;
}

bool VolumePart::SetReader(vtkAlgorithm* reader, const std::string& name,
  const std::string& array, const double* spacing)
{
  VtkMessages().AskReader(reader, name);
  vtkInformation* info = reader->GetOutputInformation(0);
  vtkInformation* voxels = VoxelsIn(info, array);
  if (!voxels || !voxels->Has(vtkDataObject::FIELD_ARRAY_TYPE()) ||
    !info->Has(Pipeline::WHOLE_EXTENT()) || !info->Get(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT()))
  {
    return false;
  }
  this->Reader = reader;
  this->Name = name;
  this->Array = array;
  info->Get(Pipeline::WHOLE_EXTENT(), this->Known.Extent.data());
  const auto take = [info](vtkInformationDoubleVectorKey* key, double* numbers)
  {
    if (info->Has(key))
    {
      info->Get(key, numbers);
    }
  };
  take(vtkDataObject::SPACING(), this->Known.Spacing.data());
  take(vtkDataObject::ORIGIN(), this->Known.Origin.data());
  take(vtkDataObject::DIRECTION(), this->Known.Direction.data());
  this->HasSpacing = spacing != nullptr;
  if (spacing)
  {
    std::copy_n(spacing, 3, this->Known.Spacing.begin());
  }
  this->Known.Type = voxels->Get(vtkDataObject::FIELD_ARRAY_TYPE());
  this->Known.Components = ComponentsIn(voxels);
  return true;
}

void VolumePart::SetWhole(const Ranks& ranks, vtkImageData* image)
{
  static_assert(std::is_trivially_copyable<VolumeFacts>::value, "sent as bytes");
  std::string bytes(sizeof(VolumeFacts), '\0');
  if (image)
  {
    const VolumeFacts facts =
      FactsOf(image, image->GetPointData()->GetScalars(), this->Component);
    std::memcpy(bytes.data(), &facts, sizeof(facts));
    bytes += image->GetPointData()->GetScalars()->GetName();
  }
  bytes = ranks.Broadcast(std::move(bytes));
  std::memcpy(&this->Known, bytes.data(), sizeof(this->Known));
  this->Array = bytes.substr(sizeof(this->Known));
  this->Whole = image;
}

VolumeFacts VolumePart::FactsOfAll(const Ranks& ranks) const
{
  VolumeFacts facts = this->Known;
  const std::vector<double> least = ranks.GatherOnAll(facts.Range[0]);
  const std::vector<double> most = ranks.GatherOnAll(facts.Range[1]);
  facts.Range = { *std::min_element(least.begin(), least.end()),
    *std::max_element(most.begin(), most.end()) };
  return facts;
}

int VolumePart::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  vtkInformation* info = output->GetInformationObject(0);
  info->Set(Pipeline::WHOLE_EXTENT(), this->Known.Extent.data(), 6);
  info->Set(vtkDataObject::SPACING(), this->Known.Spacing.data(), 3);
  info->Set(vtkDataObject::ORIGIN(), this->Known.Origin.data(), 3);
  info->Set(vtkDataObject::DIRECTION(), this->Known.Direction.data(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(info, this->Known.Type, this->Known.Components);
  if (this->Reader)
  {
    info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  }
  return 1;
}

int VolumePart::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  vtkInformation* info = output->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  int extent[6];
  info->Get(Pipeline::UPDATE_EXTENT(), extent);
  try
  {
    if (!this->Reader && this->Whole)
    {
      image->ShallowCopy(this->Whole);
    }
    else if (this->Reader && !IsEmpty(extent))
    {
      this->Read(extent, image);
    }
    else
    {
      this->MakeEmpty(image);
    }
  }
  catch (const std::exception& error)
  {
    this->Failure = ReasonOf(error, this->Name + ": not enough memory for a part of it");
    this->MakeEmpty(image);
  }
  return 1;
}

bool VolumePart::IsReadWhole() const
{
  if (!vtkXMLReader::SafeDownCast(this->Reader))
  {
    return false;
  }
  const std::array<int, 3> size = this->Known.Size();
  return static_cast<double>(size[0]) * size[1] * size[2] * this->Known.Components *
    vtkDataArray::GetDataTypeSize(this->Known.Type) <= SmallVolume;
}

void VolumePart::Read(const int* extent, vtkImageData* image)
{
  VtkMessages messages;
  messages.UpdateReader(this->Reader, this->Name, true, this->IsReadWhole() ? nullptr : extent);
  image->ShallowCopy(this->Reader->GetOutputDataObject(0));
  this->Reader->GetOutputDataObject(0)->ReleaseData();
  image->Crop(extent);
  Named(this->Name, [&] { ChooseScalars(image, this->Array); });
  if (this->HasSpacing)
  {
    image->SetSpacing(this->Known.Spacing.data());
  }
  const std::array<double, 2> range =
    RangeOf(image->GetPointData()->GetScalars(), this->Component);
  this->Known.Range[0] = std::min(this->Known.Range[0], range[0]);
  this->Known.Range[1] = std::max(this->Known.Range[1], range[1]);
}

void VolumePart::MakeEmpty(vtkImageData* image) const
{
  image->Initialize();
  image->SetExtent(0, -1, 0, -1, 0, -1);
  image->SetSpacing(this->Known.Spacing.data());
  image->SetOrigin(this->Known.Origin.data());
  image->SetDirectionMatrix(this->Known.Direction.data());
  const auto none = vtkSmartPointer<vtkDataArray>::Take(
    vtkDataArray::CreateDataArray(this->Known.Type));
  none->SetNumberOfComponents(this->Known.Components);
  none->SetName(this->Array.empty() ? "Intensity" : this->Array.c_str());
  image->GetPointData()->SetScalars(none);
}
}

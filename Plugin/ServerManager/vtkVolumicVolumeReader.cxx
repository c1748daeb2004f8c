// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicVolumeReader.h"

#include "LabelNames.h"
#include "ReadVolume.h"

#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <exception>

vtkStandardNewMacro(vtkVolumicVolumeReader);

namespace
{
/** The names that the file has, or else those of a list beside it. */
tool::LabelNames NamesOf(vtkImageData* image, const std::string& file)
{
  tool::LabelNames names = tool::GetLabelNames(image);
  names = names.empty() ? tool::ReadNamesWithin(file) : names;
  return names.empty() ? tool::ReadNamesBeside(file).Names : names;
}
}

//------------------------------------------------------------------------------
vtkVolumicVolumeReader::vtkVolumicVolumeReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkVolumicVolumeReader::~vtkVolumicVolumeReader() = default;

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::SetFileName(const char* name)
{
  const std::string wanted = name ? name : "";
  if (this->FileName != wanted)
  {
    this->FileName = wanted;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::SetSeries(const char* series)
{
  const std::string wanted = series ? series : "";
  if (this->Series != wanted)
  {
    this->Series = wanted;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::SetTime(int time)
{
  if (this->Time != time)
  {
    this->Time = time;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::SetResampling(bool on)
{
  if (this->Resampling != on)
  {
    this->Resampling = on;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
bool vtkVolumicVolumeReader::Open()
{
  if (this->OpenedTime != this->GetMTime())
  {
    this->Source = nullptr;
    this->OpenedTime = this->GetMTime();
    try
    {
      tool::VolumeChoice choice;
      choice.Series = this->Series;
      choice.Time = this->Time;
      choice.Resamples = this->Resampling;
      this->Source = tool::OpenVolume(this->FileName, "", "", choice).Source;
      this->Source->UpdateInformation();
    }
    catch (const std::exception& error)
    {
      vtkErrorMacro(<< error.what());
    }
  }
  return this->Source != nullptr;
}

//------------------------------------------------------------------------------
int vtkVolumicVolumeReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  if (!this->Open())
  {
    return 1; // The error has been told; ParaView would tell of its own readers that they failed.
  }
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* from = this->Source->GetOutputInformation(0);
  vtkInformation* to = output->GetInformationObject(0);
  to->CopyEntry(from, Pipeline::WHOLE_EXTENT());
  to->CopyEntry(from, vtkDataObject::ORIGIN());
  to->CopyEntry(from, vtkDataObject::SPACING());
  to->CopyEntry(from, vtkDataObject::DIRECTION());
  to->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkVolumicVolumeReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  if (!this->Open())
  {
    return 1;
  }
  int extent[6];
  output->GetInformationObject(0)->Get(
    vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
  this->Source->UpdateExtent(extent);
  vtkImageData* image = vtkImageData::GetData(output);
  image->ShallowCopy(this->Source->GetOutputDataObject(0));
  if (image->GetNumberOfPoints() == 0)
  {
    return 1; // The source has told why.
  }
  if (!std::equal(extent, extent + 6, image->GetExtent()))
  {
    image->Crop(extent);
  }
  tool::SetLabelNames(image, NamesOf(image, this->FileName));
  return 1;
}

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n"
     << indent << "Series: " << this->Series << "\n"
     << indent << "Time: " << this->Time << "\n"
     << indent << "Resampling: " << (this->Resampling ? "On\n" : "Off\n");
}

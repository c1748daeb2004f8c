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
#include <cstring>
#include <exception>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

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

/** What is said of options is said of properties. */
std::string InWordsOfThePanel(std::string text)
{
  static const std::pair<const char*, const char*> words[] = {
    { "choose it with --series N", "choose it as Series" }, { "(--time)", "(time step)" },
    { "without --no-resampling they are resampled", "switch Resampling on, and they are resampled" } };
  for (const auto& [option, property] : words)
  {
    const std::size_t place = text.find(option);
    text = place == std::string::npos ? text : text.replace(place, std::strlen(option), property);
  }
  return text;
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
  std::string wanted = series ? series : "";
  wanted = wanted.substr(0, 1) == "(" ? "" : wanted; // "(that of the file)", in the panel
  if (this->Series != wanted)
  {
    this->Series = wanted;
    this->Modified();
  }
}

void vtkVolumicVolumeReader::SetResampling(bool isOn)
{
  if (this->Resampling != isOn)
  {
    this->Resampling = isOn;
    this->Modified();
  }
}

vtkStringArray* vtkVolumicVolumeReader::GetSeriesList()
{
  if (this->ListedName != this->FileName)
  {
    this->ListedName = this->FileName;
    this->SeriesList->Initialize();
    try
    {
      for (const std::string& series : tool::ListSeries(this->FileName))
      {
        this->SeriesList->InsertNextValue(series);
      }
    }
    catch (const std::exception&)
    {
      this->SeriesList->Initialize(); // Why the file cannot be read is told when it is.
    }
  }
  return this->SeriesList;
}

//------------------------------------------------------------------------------
bool vtkVolumicVolumeReader::Open(int time)
{
  if (this->OpenedTime != this->GetMTime() || (this->Source && this->OpenedStep != time))
  {
    this->Source = nullptr;
    this->OpenedTime = this->GetMTime();
    this->OpenedStep = time;
    tool::VolumeChoice choice;
    choice.Series = this->Series.substr(0, this->Series.find(':'));
    choice.Time = time;
    choice.Times = std::make_shared<int>(1);
    choice.Resamples = this->Resampling;
    try
    {
      this->Source = tool::OpenVolume(this->FileName, "", "", choice).Source;
      this->Source->UpdateInformation();
    }
    catch (const std::exception& error)
    {
      vtkErrorMacro(<< InWordsOfThePanel(error.what()));
    }
    this->Times = *choice.Times;
  }
  return this->Source != nullptr;
}

//------------------------------------------------------------------------------
int vtkVolumicVolumeReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  if (!this->Open(0))
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
  to->Remove(Pipeline::TIME_STEPS());
  to->Remove(Pipeline::TIME_RANGE());
  if (this->Times > 1)
  {
    std::vector<double> steps(static_cast<std::size_t>(this->Times));
    std::iota(steps.begin(), steps.end(), 0.0);
    const double range[2] = { steps.front(), steps.back() };
    to->Set(Pipeline::TIME_STEPS(), steps.data(), this->Times);
    to->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkVolumicVolumeReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* asked = output->GetInformationObject(0);
  const double time =
    asked->Has(Pipeline::UPDATE_TIME_STEP()) ? asked->Get(Pipeline::UPDATE_TIME_STEP()) : 0.0;
  // Of a series of files it is the time of the file.
  if (!this->Open(this->Times > 1 ? std::clamp(static_cast<int>(time), 0, this->Times - 1) : 0))
  {
    return 1;
  }
  int extent[6];
  asked->Get(Pipeline::UPDATE_EXTENT(), extent);
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
  if (this->Times > 1)
  {
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->OpenedStep);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkVolumicVolumeReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "Series: " << this->Series << "\n";
  os << indent << "Resampling: " << this->Resampling << "\n";
}

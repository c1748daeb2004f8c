// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImagePyramid.h"

#include "Core/Common/Join.h"
#include "Core/Image/PyramidGeometry.h"
#include "Host/Errors.h"
#include "Host/LimitedMemory.h"
#include "Host/Pipeline.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Input/SlabInput.h"
#include "Pyramid/PyramidBlocks.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkImagePyramid);

namespace
{
volumic::PyramidOptions OptionsOf(
  double reductionFactor, int numberOfLevels, int minimumLevelSize)
{
  volumic::PyramidOptions options;
  options.ReductionFactor = reductionFactor;
  options.NumberOfLevels = numberOfLevels;
  options.MinimumLevelSize = minimumLevelSize;
  return options;
}
}

//------------------------------------------------------------------------------
/** What the filter holds beside what all algorithms do. */
class vtkImagePyramid::vtkInternals
{
public:
  std::string ScratchDirectory;
  volumic::LimitedMemory Memory; ///< as the last run had it
  bool HasToldOfWhole = false;
};

//------------------------------------------------------------------------------
vtkImagePyramid::vtkImagePyramid() : Internals(std::make_unique<vtkInternals>())
{
  const volumic::PyramidOptions defaults;
  this->ReductionFactor = defaults.ReductionFactor;
  this->NumberOfLevels = defaults.NumberOfLevels;
  this->MinimumLevelSize = defaults.MinimumLevelSize;
  this->SelectedComponent = -1;
  this->NaNIsBackground = true;
  this->NumberOfThreads = 0;
  this->MemoryLimit = 0;
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkImagePyramid::~vtkImagePyramid() = default;

//------------------------------------------------------------------------------
vtkMultiBlockDataSet* vtkImagePyramid::GetOutput()
{
  return this->GetOutput(0);
}

vtkMultiBlockDataSet* vtkImagePyramid::GetOutput(int port)
{
  return vtkMultiBlockDataSet::SafeDownCast(this->GetOutputDataObject(port));
}

//------------------------------------------------------------------------------
void vtkImagePyramid::SetScratchDirectory(const char* directory)
{
  const std::string wanted = directory ? directory : "";
  if (this->Internals->ScratchDirectory != wanted)
  {
    this->Internals->ScratchDirectory = wanted;
    this->Modified();
  }
}

const char* vtkImagePyramid::GetScratchDirectory()
{
  return this->Internals->ScratchDirectory.c_str();
}

//------------------------------------------------------------------------------
int vtkImagePyramid::CountLevels(int sizeX, int sizeY, int sizeZ) const
{
  try
  {
    return static_cast<int>(volumic::PlanPyramid({ sizeX, sizeY, sizeZ }, { 1.0, 1.0, 1.0 },
      OptionsOf(this->ReductionFactor, this->NumberOfLevels, this->MinimumLevelSize))
        .size());
  }
  catch (const std::invalid_argument&)
  {
    return 0;
  }
}

//------------------------------------------------------------------------------
vtkTypeBool vtkImagePyramid::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  // vtkImageAlgorithm knows images only and leaves this request to others.
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->RequestDataObject(output);
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkImagePyramid::RequestDataObject(vtkInformationVector* output)
{
  vtkInformation* info = output->GetInformationObject(0);
  if (!vtkMultiBlockDataSet::GetData(info))
  {
    vtkNew<vtkMultiBlockDataSet> pyramid;
    info->Set(vtkDataObject::DATA_OBJECT(), pyramid);
  }
  return 1;
}

int vtkImagePyramid::FillInputPortInformation(int, vtkInformation* info)
{
  // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkImagePyramid::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkMultiBlockDataSet");
  return 1;
}

int vtkImagePyramid::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  // What the executive copied from the input speaks of an image: blocks have no whole extent.
  vtkInformation* info = output->GetInformationObject(0);
  info->Remove(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  info->Remove(vtkDataObject::ORIGIN());
  info->Remove(vtkDataObject::SPACING());
  return 1;
}

int vtkImagePyramid::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::RequestInputs(this, request, input, output);
  if (this->MemoryLimit > 0 && volumic::IsFirstProcess(request, output))
  {
    volumic::SlabInput(this).Ask(volumic::LimitedMemory::BytesOf(this->MemoryLimit), true);
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkImagePyramid::ReadInput(
  vtkInformationVector* input, int& component)
{
  volumic::LimitedMemory& memory = this->Internals->Memory;
  memory.Set(this->MemoryLimit, this->Internals->ScratchDirectory);
  component = this->SelectedComponent;
  vtkDataObject* data = volumic::WholeInput(input);
  volumic::SlabInput::Result slabs;
  if (memory.Limit() > 0)
  {
    volumic::SlabInput::Request request;
    request.Limit = memory.Limit();
    request.Selection = this->GetInputArrayInformation(0);
    request.SelectedComponent = component;
    request.GoOn = [this](double share) { return this->ShowProgress(share, "Reading the image"); };
    slabs = volumic::SlabInput(this).Read(request);
    const std::string whole = volumic::SlabInput(this).DescribeWhole();
    if (!whole.empty() && !std::exchange(this->Internals->HasToldOfWhole, true))
    {
      vtkWarningMacro("Input port 0: " << whole);
    }
  }
  if (slabs.IsStopped)
  {
    return nullptr;
  }
  component = slabs.Image ? -1 : component; // It has been selected.
  return slabs.Image ? slabs.Image : vtkSmartPointer<vtkImageData>(volumic::ImageOf(data));
}

//------------------------------------------------------------------------------
volumic::PyramidBlocks vtkImagePyramid::MakeBlocks(
  vtkInformationVector* input, vtkSmartPointer<vtkImageData>& image)
{
  int component = this->SelectedComponent;
  image = this->ReadInput(input, component);
  if (!image)
  {
    return volumic::StoppedPyramidBlocks();
  }
  const vtkSmartPointer<vtkDataArray> voxels = volumic::SelectComponent(
    volumic::ChooseArray(this->GetInputArrayInformation(0), image), component);
  volumic::PyramidRequest request;
  request.Levels =
    OptionsOf(this->ReductionFactor, this->NumberOfLevels, this->MinimumLevelSize);
  request.NaNIsBackground = this->NaNIsBackground;
  request.NumberOfThreads = this->NumberOfThreads;
  request.Progress = [this](double share, const std::string& text)
  { return this->ShowProgress(share, text); };
  return volumic::MakePyramidBlocks(image, voxels, request);
}

//------------------------------------------------------------------------------
void vtkImagePyramid::MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output)
{
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  input->GetInformationObject(0)->Get(
    vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  const auto levels = static_cast<unsigned int>(this->CountLevels(
    extent[1] - extent[0] + 1, extent[3] - extent[2] + 1, extent[5] - extent[4] + 1));
  output->SetNumberOfBlocks(levels);
  for (unsigned int h = 0; h < levels; ++h)
  {
    output->GetMetaData(h)->Set(
      vtkCompositeDataSet::NAME(), volumic::Join("Level ", h).c_str());
  }
}

//------------------------------------------------------------------------------
bool vtkImagePyramid::ShowProgress(double share, const std::string& text)
{
  this->SetProgressText(text.c_str());
  this->UpdateProgress(share);
  return !volumic::IsAbortRequested(this);
}

//------------------------------------------------------------------------------
int vtkImagePyramid::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    this->MakeEmptyBlocks(inputVector[0], vtkMultiBlockDataSet::GetData(outputVector));
    return 1;
  }
  // ParaView leaves the flag of an earlier run as it is.
  volumic::ForgetAbort(this);
  vtkSmartPointer<vtkImageData> image;
  const auto work = [&]
  {
    const volumic::PyramidBlocks pyramid = this->MakeBlocks(inputVector[0], image);
    vtkMultiBlockDataSet::GetData(outputVector)->ShallowCopy(pyramid.Blocks);
    if (!pyramid.AboutNaNs.empty())
    {
      vtkWarningMacro("Input port 0: " << pyramid.AboutNaNs);
    }
    for (const std::string& warning : this->Internals->Memory.TakeWarnings())
    {
      vtkWarningMacro(<< warning);
    }
  };
  const volumic::AlgorithmError error = volumic::RunAlgorithm(outputVector,
    [&]
    {
      return volumic::Join("the memory does not suffice for the pyramid of an image of ",
        image ? volumic::SizeOf(image) : "?", " voxels.");
    },
    work);
  if (error.Code != vtkErrorCode::NoError)
  {
    this->SetErrorCode(error.Code);
    vtkErrorMacro("Input port 0: " << error.Text);
  }
  volumic::ForgetAbort(this);
  return 1;
}

//------------------------------------------------------------------------------
void vtkImagePyramid::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ReductionFactor: " << this->ReductionFactor << endl;
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << endl;
  os << indent << "MinimumLevelSize: " << this->MinimumLevelSize << endl;
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "NaNIsBackground: " << this->NaNIsBackground << endl;
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << endl;
  os << indent << "MemoryLimit: " << this->MemoryLimit << endl;
  os << indent << "ScratchDirectory: " << this->Internals->ScratchDirectory << endl;
}

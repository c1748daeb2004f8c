// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImagePyramid.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/PyramidGeometry.h"
#include "Host/Errors.h"
#include "Host/LargeArrays.h"
#include "Host/Pipeline.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Pyramid/PyramidBlocks.h"
#include "Ranks/Ranks.h"

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
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <cstddef>
#include <cstdint>
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
  vtkSmartPointer<vtkMultiProcessController> Controller;
  std::string ScratchDirectory;

  /**
   * The pieces of the last run on several ranks. Some filters (vtkCleanPolyData) ask all ranks but
   * the first one for nothing in between; when those are asked for their pieces again, the first
   * one still has its own, makes nothing, and would not answer.
   */
  vtkSmartPointer<vtkMultiBlockDataSet> Kept;
  vtkMTimeType TimeOfKept = 0;
  int RanksOfKept = 0;
  int GhostLevelsOfKept = 0;

  void Keep(vtkImagePyramid* filter, const volumic::Ranks& ranks, int ghostLevels,
    vtkMultiBlockDataSet* pyramid)
  {
    const bool isReleased = vtkDataObject::GetGlobalReleaseDataFlag() != 0 ||
      filter->GetExecutive()->GetOutputInformation(0)->Get(vtkDemandDrivenPipeline::RELEASE_DATA());
    this->Kept = nullptr;
    if (ranks.AreMany() && !isReleased)
    {
      this->Kept = vtkSmartPointer<vtkMultiBlockDataSet>::New();
      this->Kept->ShallowCopy(pyramid);
    }
    this->TimeOfKept = TimeOf(filter);
    this->RanksOfKept = ranks.Count();
    this->GhostLevelsOfKept = ghostLevels;
  }
  bool Has(vtkImagePyramid* filter, const volumic::Ranks& ranks, int ghostLevels) const
  {
    return this->Kept && this->TimeOfKept == TimeOf(filter) &&
      this->RanksOfKept == ranks.Count() && this->GhostLevelsOfKept >= ghostLevels;
  }

private:
  /** When the filter, or what comes before it, was changed last. */
  static vtkMTimeType TimeOf(vtkImagePyramid* filter)
  {
    return vtkDemandDrivenPipeline::SafeDownCast(filter->GetExecutive())->GetPipelineMTime();
  }
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
  this->Internals->Controller = vtkMultiProcessController::GetGlobalController();
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
void vtkImagePyramid::SetMemoryLimit(int mebibytes)
{
  if (mebibytes != 0 && this->MemoryLimit == 0)
  {
    vtkWarningMacro("MemoryLimit is deprecated and has no effect. " VOLUMIC_ABOUT_MEMORY);
  }
  this->MemoryLimit = mebibytes;
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
void vtkImagePyramid::SetController(vtkMultiProcessController* controller)
{
  if (this->Internals->Controller != controller)
  {
    this->Internals->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkImagePyramid::GetController()
{
  return this->Internals->Controller;
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
  catch (const volumic::Refusal&)
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
  volumic::Ranks(this->Internals->Controller, { this, request, input, output }).AskForInputs();
  return 1;
}

//------------------------------------------------------------------------------
volumic::PyramidBlocks vtkImagePyramid::MakeBlocks(
  volumic::Ranks& ranks, vtkSmartPointer<vtkImageData>& image)
{
  const volumic::ScratchMemory scratch(this->Internals->ScratchDirectory);
  const vtkSmartPointer<vtkDataObject> input = ranks.TakeImages(0);
  image = volumic::ImageOf(input);
  const vtkSmartPointer<vtkDataArray> voxels = volumic::SelectComponent(
    volumic::ChooseArray(this->GetInputArrayInformation(0), image), this->SelectedComponent);
  volumic::PyramidRequest request;
  request.Levels =
    OptionsOf(this->ReductionFactor, this->NumberOfLevels, this->MinimumLevelSize);
  request.NaNIsBackground = this->NaNIsBackground;
  request.NumberOfThreads = this->NumberOfThreads;
  request.Progress = [&ranks](double share, const std::string& text)
  { return ranks.GoOn(share, text); };
  return volumic::MakePyramidBlocks(image, voxels, request);
}

//------------------------------------------------------------------------------
int vtkImagePyramid::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  const auto show = [this](double share, const std::string& text)
  {
    this->SetProgressText(text.c_str());
    this->UpdateProgress(share);
    return !volumic::IsAbortRequested(this);
  };
  vtkInternals& internals = *this->Internals;
  volumic::Ranks ranks(internals.Controller, { this, request, inputVector, outputVector }, show);
  // Of processes that don't work together the first one holds the pyramid; the others would only
  // repeat it.
  if (!ranks.AreMany() && !volumic::IsFirstProcess(request, outputVector))
  {
    return 1;
  }
  const int ghostLevels = volumic::GhostLevelsAskedOf(request, outputVector);
  if (ranks.AreMany() && internals.Has(this, ranks, ghostLevels))
  {
    vtkMultiBlockDataSet::GetData(outputVector)->ShallowCopy(internals.Kept);
    return 1;
  }
  internals.Kept = nullptr;
  // ParaView leaves the flag of an earlier run as it is.
  volumic::ForgetAbort(this);
  vtkSmartPointer<vtkImageData> image;
  volumic::RankWork work;
  work.OfFirst = [&]
  {
    const volumic::PyramidBlocks pyramid = this->MakeBlocks(ranks, image);
    vtkMultiBlockDataSet::GetData(outputVector)->ShallowCopy(pyramid.Blocks);
    if (!pyramid.AboutNaNs.empty())
    {
      vtkWarningMacro("Input port 0: " << pyramid.AboutNaNs);
    }
  };
  const volumic::AlgorithmError error = ranks.Run(
    [&]
    {
      return volumic::Join("the memory does not suffice for the pyramid of an image of ",
        image ? volumic::SizeOf(image) : "?", " voxels.");
    },
    work);
  if (error.Code == vtkErrorCode::NoError)
  {
    internals.Keep(this, ranks, ghostLevels, vtkMultiBlockDataSet::GetData(outputVector));
  }
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

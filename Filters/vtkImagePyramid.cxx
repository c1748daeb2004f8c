// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImagePyramid.h"

#include "AlgorithmErrors.h"
#include "Core/Image/PyramidGeometry.h"
#include "HostThreads.h"
#include "ImageVoxels.h"
#include "InputImage.h"
#include "LimitedMemory.h"
#include "LevelVoxels.h"
#include "SlabInput.h"
#include "ValidVoxels.h"
#include "VersionCompatibility.h"
#include "WholeInput.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkImagePyramid);

namespace
{
std::vector<volumic::LevelGeometry> Plan(
  vtkImageData* image, const volumic::PyramidOptions& options)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  return volumic::PlanPyramid(
    { size[0], size[1], size[2] }, { spacing[0], spacing[1], spacing[2] }, options);
}

void AddLevelFieldData(vtkImageData* image, int level, double unit)
{
  vtkNew<vtkIntArray> levelArray;
  levelArray->SetName("Level");
  levelArray->InsertNextValue(level);
  vtkNew<vtkDoubleArray> unitArray;
  unitArray->SetName("Unit");
  unitArray->InsertNextValue(unit);
  // Not into the input's own field data, which a shallow copy may share.
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(image->GetFieldData());
  fieldData->AddArray(levelArray);
  fieldData->AddArray(unitArray);
  image->SetFieldData(fieldData);
}

void AddLevel(vtkMultiBlockDataSet* pyramid, int level, vtkImageData* image, double unit)
{
  AddLevelFieldData(image, level, unit);
  pyramid->SetBlock(level, image);
  pyramid->GetMetaData(level)->Set(
    vtkCompositeDataSet::NAME(), ("Level " + std::to_string(level)).c_str());
}

vtkSmartPointer<vtkImageData> MakeImage(vtkImageData* input, const char* name, vtkDataArray* voxels,
  const volumic::LevelGeometry& geometry)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(0, static_cast<int>(geometry.Size[0]) - 1, 0,
    static_cast<int>(geometry.Size[1]) - 1, 0, static_cast<int>(geometry.Size[2]) - 1);
  image->SetSpacing(geometry.Spacing.data());
  image->SetDirectionMatrix(input->GetDirectionMatrix());
  const int* extent = input->GetExtent();
  double origin[3];
  input->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], origin);
  image->SetOrigin(origin);
  voxels->SetName(name);
  image->GetPointData()->SetScalars(voxels);
  return image;
}

struct Settings
{
  volumic::PyramidOptions Levels;
  bool NaNIsBackground;
  int NumberOfThreads;
};

/** @return whether all levels were finished. */
bool BuildPyramid(vtkImageData* input, vtkDataArray* voxels, const Settings& settings,
  const volumic::PyramidProgress& progress, vtkMultiBlockDataSet* pyramid,
  volumic::ValidVoxels& valid)
{
  const std::vector<volumic::LevelGeometry> levels = Plan(input, settings.Levels);
  std::vector<vtkSmartPointer<vtkDataArray>> made;

  volumic::HostThreads threads(settings.NumberOfThreads);
  threads.Run(
    [&]
    {
      const vtkSmartPointer<vtkDataArray> contiguous = volumic::ContiguousVoxels(voxels);
      valid = volumic::FindValidVoxels(
        voxels, contiguous, input, settings.NaNIsBackground, threads);
      volumic::CheckAnyIsValid(voxels, valid);
      made = volumic::MakeLevelVoxels(contiguous, valid, levels, threads, progress);
    });

  // No voxel is copied, but where one component was selected, which takes the place of the array.
  AddLevel(pyramid, 0, volumic::WithVoxels(input, voxels), levels[0].Unit);
  for (std::size_t h = 1; h <= made.size(); ++h)
  {
    AddLevel(pyramid, static_cast<int>(h),
      MakeImage(input, voxels->GetName(), made[h - 1], levels[h]), levels[h].Unit);
  }
  return made.size() + 1 == levels.size();
}

volumic::PyramidOptions OptionsOf(
  double reductionFactor, int numberOfLevels, int minimumLevelSize)
{
  volumic::PyramidOptions options;
  options.ReductionFactor = reductionFactor;
  options.NumberOfLevels = numberOfLevels;
  options.MinimumLevelSize = minimumLevelSize;
  return options;
}

void AddFacts(vtkMultiBlockDataSet* pyramid, bool isComplete, std::int64_t numberOfNaNs)
{
  vtkNew<vtkIdTypeArray> nans;
  nans->SetName("NaNVoxels");
  nans->InsertNextValue(static_cast<vtkIdType>(numberOfNaNs));
  pyramid->GetFieldData()->AddArray(nans);
  vtkNew<vtkStringArray> reason;
  reason->SetName("StopReason");
  reason->InsertNextValue(isComplete ? "complete" : "cancelled");
  pyramid->GetFieldData()->AddArray(reason);
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
  volumic::AskForWholeInputs(request, input, 1, output);
  if (this->MemoryLimit > 0 && volumic::IsFirstProcess(request, output))
  {
    volumic::SlabInput(this).Ask(volumic::LimitedMemory::BytesOf(this->MemoryLimit), true);
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkImagePyramid::ReadInput(vtkDataObject* input, int& component)
{
  volumic::LimitedMemory& memory = this->Internals->Memory;
  memory.Set(this->MemoryLimit, this->Internals->ScratchDirectory);
  component = this->SelectedComponent;
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
  return slabs.Image ? slabs.Image : vtkSmartPointer<vtkImageData>(volumic::ImageOf(input));
}

//------------------------------------------------------------------------------
bool vtkImagePyramid::ShowProgress(double share, const std::string& text)
{
  this->SetProgressText(text.c_str());
  this->UpdateProgress(share);
  return !volumic::IsAbortRequested(this);
}

//------------------------------------------------------------------------------
void vtkImagePyramid::MakeLevels(
  vtkDataObject* input, vtkSmartPointer<vtkImageData>& image, vtkMultiBlockDataSet* output)
{
  int component = -1;
  image = this->ReadInput(input, component);
  vtkNew<vtkMultiBlockDataSet> pyramid;
  volumic::ValidVoxels valid;
  bool isComplete = false;
  vtkSmartPointer<vtkDataArray> voxels;
  if (image)
  {
    voxels = volumic::SelectComponent(
      volumic::ChooseArray(this->GetInputArrayInformation(0), image), component);
    Settings settings;
    settings.Levels =
      OptionsOf(this->ReductionFactor, this->NumberOfLevels, this->MinimumLevelSize);
    settings.NaNIsBackground = this->NaNIsBackground;
    settings.NumberOfThreads = this->NumberOfThreads;
    const auto progress = [this](double share, const std::string& text)
    { return this->ShowProgress(share, text); };
    isComplete = BuildPyramid(image, voxels, settings, progress, pyramid, valid);
  }
  AddFacts(pyramid, isComplete, valid.NaNs);
  output->ShallowCopy(pyramid);
  if (valid.NaNs > 0)
  {
    vtkWarningMacro("Input port 0: " << volumic::DescribeNaNs(voxels, image, valid));
  }
}

//------------------------------------------------------------------------------
int vtkImagePyramid::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  // In a parallel run the first process holds the pyramid; the others would only repeat it.
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    return 1;
  }
  vtkSmartPointer<vtkImageData> image;
  try
  {
    // ParaView leaves the flag of an earlier run as it is.
    volumic::ForgetAbort(this);
    this->MakeLevels(
      vtkDataObject::GetData(inputVector[0]), image, vtkMultiBlockDataSet::GetData(outputVector));
    for (const std::string& warning : this->Internals->Memory.TakeWarnings())
    {
      vtkWarningMacro(<< warning);
    }
  }
  catch (const std::bad_alloc& error)
  {
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: the memory does not suffice for the pyramid of an image of "
      << (image ? volumic::SizeOf(image) : "?") << " voxels.");
  }
  catch (const std::exception& error)
  {
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: " << error.what());
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

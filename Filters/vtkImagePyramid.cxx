// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImagePyramid.h"

#include "AlgorithmErrors.h"
#include "Core/Join.h"
#include "Core/LevelReduction.h"
#include "Core/PyramidGeometry.h"
#include "HostThreads.h"
#include "ImageVoxels.h"
#include "NotFiniteVoxels.h"
#include "VersionCompatibility.h"
#include "WholeInput.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDemandDrivenPipeline.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
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

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkImagePyramid);

namespace
{
/// The share of the whole work that is done, in [0, 1], and the text for it; false asks to stop.
using Progress = std::function<bool(double share, const std::string& text)>;

std::vector<volumic::LevelGeometry> Plan(
  vtkImageData* image, const volumic::PyramidOptions& options)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  return volumic::PlanPyramid(
    { size[0], size[1], size[2] }, { spacing[0], spacing[1], spacing[2] }, options);
}

/// An array of n values in memory that may turn out not to be had, which is no reason to abort.
template <typename Real>
vtkSmartPointer<vtkAOSDataArrayTemplate<Real>> NewArray(std::int64_t n, int level)
{
  auto* values = static_cast<Real*>(std::malloc(static_cast<std::size_t>(n) * sizeof(Real)));
  if (!values)
  {
    throw std::runtime_error(volumic::Join("the memory does not suffice for level ", level,
      ", which takes ", static_cast<double>(n) * sizeof(Real) / (1024. * 1024.),
      " MB. Ask for fewer levels, or crop the image."));
  }
  vtkSmartPointer<vtkAOSDataArrayTemplate<Real>> array;
  array.TakeReference(vtkAOSDataArrayTemplate<Real>::FastDownCast(
    vtkDataArray::CreateDataArray(vtkTypeTraits<Real>::VTK_TYPE_ID)));
  array->SetArray(values, n, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  return array;
}

/// The voxels that level 1 is made of: as double where they are integers that single precision would
/// not keep apart.
vtkSmartPointer<vtkDataArray> SourceVoxels(vtkDataArray* voxels, volumic::Executor& executor)
{
  const vtkSmartPointer<vtkDataArray> contiguous = volumic::ContiguousVoxels(voxels);
  const int type = contiguous->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE || contiguous->GetDataTypeSize() < 4)
  {
    return contiguous;
  }
  double range[2];
  contiguous->GetRange(range);
  if (volumic::FloatHolds(range[0], range[1]))
  {
    return contiguous;
  }
  const auto wide = NewArray<double>(contiguous->GetNumberOfTuples(), 0);
  const auto copy = [&](const auto* values)
  {
    executor.For(static_cast<std::size_t>(wide->GetNumberOfTuples()), 1 << 16,
      [&](std::size_t begin, std::size_t end)
      {
        std::transform(values + begin, values + end, wide->GetPointer(0) + begin,
          [](auto value) { return static_cast<double>(value); });
      });
  };
  switch (type)
  {
    vtkTemplateMacro(copy(static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0))));
  }
  return wide;
}

/// Input voxels of each level that are looked at: what progress is measured by.
std::vector<double> ShareDoneBefore(const std::vector<volumic::LevelGeometry>& levels)
{
  std::vector<double> share(levels.size(), 0.0);
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    share[h] = share[h - 1] + static_cast<double>(levels[h - 1].NumberOfVoxels());
  }
  const double total = share.back();
  for (double& s : share)
  {
    s = total > 0.0 ? s / total : 1.0;
  }
  return share;
}

/**
 * The voxels of the levels above level 0, as far as they were finished before `progress` said stop.
 */
template <typename T>
std::vector<vtkSmartPointer<vtkDataArray>> MakeLevels(const T* level0,
  const std::vector<volumic::LevelGeometry>& levels, volumic::Executor& executor,
  const Progress& progress)
{
  using Real = typename volumic::RealOf<T>::Type;
  const std::vector<double> before = ShareDoneBefore(levels);
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  const Real* below = nullptr;
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    const auto array = NewArray<Real>(levels[h].NumberOfVoxels(), static_cast<int>(h));
    const std::string text = volumic::Join("Level ", h, " of ", levels.size() - 1);
    const auto levelProgress = [&](double share)
    { return progress(before[h - 1] + share * (before[h] - before[h - 1]), text); };
    const bool isFinished = levelProgress(0.0) &&
      (h == 1 ? volumic::ReduceLevel(
                  level0, levels[0], array->GetPointer(0), levels[1], executor, levelProgress)
              : volumic::ReduceLevel(
                  below, levels[h - 1], array->GetPointer(0), levels[h], executor, levelProgress));
    if (!isFinished)
    {
      break;
    }
    below = array->GetPointer(0);
    made.emplace_back(array);
  }
  return made;
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

/// Level 0: the input with the chosen array as its active scalars; no voxel is copied.
vtkSmartPointer<vtkImageData> ShareInput(vtkImageData* input, vtkDataArray* voxels)
{
  vtkSmartPointer<vtkImageData> image;
  image.TakeReference(input->NewInstance());
  image->ShallowCopy(input);
  if (voxels->GetName())
  {
    image->GetPointData()->SetActiveScalars(voxels->GetName());
  }
  return image;
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

/// @return whether all levels were finished.
bool BuildPyramid(vtkImageData* input, vtkDataArray* voxels, const volumic::PyramidOptions& options,
  int numberOfThreads, const Progress& progress, vtkMultiBlockDataSet* pyramid)
{
  const std::vector<volumic::LevelGeometry> levels = Plan(input, options);
  std::vector<vtkSmartPointer<vtkDataArray>> made;

  volumic::HostThreads threads(numberOfThreads);
  threads.Run(
    [&]
    {
      const vtkSmartPointer<vtkDataArray> contiguous = SourceVoxels(voxels, threads);
      const std::string notFinite =
        volumic::DescribeNotFiniteVoxels(voxels, contiguous, input, threads);
      if (!notFinite.empty())
      {
        throw std::invalid_argument(notFinite);
      }
      switch (contiguous->GetDataType())
      {
        vtkTemplateMacro({
          const auto* values = static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0));
          made = MakeLevels(values, levels, threads, progress);
        });
        default:
          throw std::invalid_argument(volumic::NameOf(voxels) + " has voxels of type " +
            voxels->GetDataTypeAsString() + ", which is not supported.");
      }
    });

  AddLevel(pyramid, 0, ShareInput(input, voxels), levels[0].Unit);
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

void AddStopReason(vtkMultiBlockDataSet* pyramid, bool isComplete)
{
  vtkNew<vtkStringArray> reason;
  reason->SetName("StopReason");
  reason->InsertNextValue(isComplete ? "complete" : "cancelled");
  pyramid->GetFieldData()->AddArray(reason);
}
}

//------------------------------------------------------------------------------
vtkImagePyramid::vtkImagePyramid()
{
  const volumic::PyramidOptions defaults;
  this->ReductionFactor = defaults.ReductionFactor;
  this->NumberOfLevels = defaults.NumberOfLevels;
  this->MinimumLevelSize = defaults.MinimumLevelSize;
  this->NumberOfThreads = 0;
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
  return 1;
}

//------------------------------------------------------------------------------
int vtkImagePyramid::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkMultiBlockDataSet* output = vtkMultiBlockDataSet::GetData(outputVector);
  // In a parallel run the first process holds the pyramid; the others would only repeat it.
  if (output &&
    outputVector->GetInformationObject(0)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0)
  {
    return 1;
  }
  if (!input || !output)
  {
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro("Input port 0: there is no image.");
    return 1;
  }
  try
  {
    // ParaView leaves the flag of an earlier run as it is.
    volumic::ForgetAbort(this);
    vtkDataArray* voxels = volumic::ChooseVoxels(this->GetInputArrayInformation(0), input);
    const volumic::PyramidOptions options =
      OptionsOf(this->ReductionFactor, this->NumberOfLevels, this->MinimumLevelSize);
    const auto progress = [this](double share, const std::string& text)
    {
      this->SetProgressText(text.c_str());
      this->UpdateProgress(share);
      return !volumic::IsAbortRequested(this);
    };

    vtkNew<vtkMultiBlockDataSet> pyramid;
    const bool isComplete =
      BuildPyramid(input, voxels, options, this->NumberOfThreads, progress, pyramid);
    AddStopReason(pyramid, isComplete);
    output->ShallowCopy(pyramid);
  }
  catch (const std::bad_alloc& error)
  {
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: the memory does not suffice for the pyramid of an image of "
      << volumic::SizeOf(input) << " voxels.");
  }
  catch (const std::exception& error)
  {
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: " << error.what());
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkImagePyramid::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ReductionFactor: " << this->ReductionFactor << endl;
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << endl;
  os << indent << "MinimumLevelSize: " << this->MinimumLevelSize << endl;
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << endl;
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImagePyramid.h"

#include "Core/Common/Join.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/PyramidGeometry.h"
#include "Host/Errors.h"
#include "Host/LargeArrays.h"
#include "Host/Pipeline.h"
#include "Host/RunObserver.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"
#include "Pyramid/ImageLevels.h"
#include "Settings/PropertyTable.h"

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
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkImagePyramid);

//------------------------------------------------------------------------------
/** Members of vtkImagePyramid. */
class vtkImagePyramid::vtkInternals
{
public:
  volumic::LevelsOptions Options;
  int SelectedComponent = -1;
  int MemoryLimit = 0; ///< deprecated
  std::string ScratchDirectory;
};

//------------------------------------------------------------------------------
vtkImagePyramid::vtkImagePyramid() : Internals(std::make_unique<vtkInternals>())
{
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
VOLUMIC_DEPRECATED(vtkImagePyramid, MemoryLimit, int, VOLUMIC_MEMORY_LIMIT_WARNING)

// The properties: name, type of Set and Get, member of vtkInternals.
#define VOLUMIC_PYRAMID_FILTER_PROPERTIES(MADE)                  \
  MADE(ReductionFactor, double, Options.Pyramid.ReductionFactor) \
  MADE(NumberOfLevels, int, Options.Pyramid.NumberOfLevels)      \
  MADE(MinimumLevelSize, int, Options.Pyramid.MinimumLevelSize)  \
  MADE(SelectedComponent, int, SelectedComponent)                \
  MADE(NaNIsBackground, bool, Options.NaNIsBackground)           \
  MADE(NumberOfThreads, int, Options.NumberOfThreads)            \
  MADE(ScratchDirectory, const char*, ScratchDirectory)

#define VolumicSetting(name, type, field) \
  VOLUMIC_SET_AND_GET(vtkImagePyramid, name, type, Internals->field, this->Modified())
VOLUMIC_PYRAMID_FILTER_PROPERTIES(VolumicSetting)

//------------------------------------------------------------------------------
int vtkImagePyramid::CountLevels(int sizeX, int sizeY, int sizeZ) const
{
  try
  {
    return static_cast<int>(volumic::PlanPyramid(
      { sizeX, sizeY, sizeZ }, { 1.0, 1.0, 1.0 }, this->Internals->Options.Pyramid)
                              .size());
  }
  catch (const volumic::InvalidArgument&)
  {
    return 0;
  }
}

//------------------------------------------------------------------------------
vtkTypeBool vtkImagePyramid::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  // vtkImageAlgorithm does not handle this request.
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
  // Accept any type, or the pipeline would run the filter once per leaf of a composite dataset.
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
  // The executive has copied this information from the input. Blocks have no whole extent.
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
  return 1;
}

//------------------------------------------------------------------------------
volumic::ImageLevels vtkImagePyramid::MakeLevels(
  vtkDataObject* input, vtkSmartPointer<vtkImageData>& image, volumic::RunObserver& observer)
{
  const volumic::ScratchMemory scratch(this->Internals->ScratchDirectory);
  image = volumic::ImageOf(input);
  const vtkSmartPointer<vtkDataArray> voxels =
    volumic::SelectComponent(volumic::ChooseArray(this->GetInputArrayInformation(0), image),
      this->Internals->SelectedComponent);
  return volumic::MakeImageLevels(image, voxels, this->Internals->Options,
    [&observer](double fraction, const std::string& text)
    { return observer.ReportProgress(fraction, text); });
}

//------------------------------------------------------------------------------
void vtkImagePyramid::MakeEmptyBlocks(vtkInformationVector* input, vtkMultiBlockDataSet* output)
{
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  input->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  volumic::MakeNullBlocks(output,
    volumic::LevelNames(this->CountLevels(
      extent[1] - extent[0] + 1, extent[3] - extent[2] + 1, extent[5] - extent[4] + 1)));
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
  vtkSmartPointer<vtkImageData> image;
  std::vector<std::string> warnings;
  this->SetErrorCode(volumic::RunAlgorithm(
    this, outputVector, "Input port 0: ",
    [&]
    {
      return volumic::Join("not enough memory for the pyramid of an image of ",
        image ? volumic::SizeOf(image) : "?", " voxels. Set Scratch Directory, or crop the image.");
    },
    [&]
    {
      volumic::RunObserver observer(this, 0.0, warnings);
      const volumic::ImageLevels levels =
        this->MakeLevels(volumic::WholeInput(inputVector[0]), image, observer);
      vtkMultiBlockDataSet::GetData(outputVector)->ShallowCopy(volumic::BlocksOf(levels));
      if (!levels.NaNWarning.empty())
      {
        observer.Warn("Input port 0: " + levels.NaNWarning);
      }
    }));
  if (this->GetErrorCode() != vtkErrorCode::NoError &&
    !volumic::IsOnlyProcess(request, outputVector))
  {
    this->MakeEmptyBlocks(inputVector[0], vtkMultiBlockDataSet::GetData(outputVector));
  }
  for (const std::string& text : warnings)
  {
    vtkWarningMacro(<< text);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkImagePyramid::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define VolumicPrint(name, type, field)                                      \
  volumic::PrintSetting(os << indent << #name ": ", this->Internals->field); \
  os << endl;
  VOLUMIC_PYRAMID_FILTER_PROPERTIES(VolumicPrint)
  os << indent << "MemoryLimit: " << this->Internals->MemoryLimit << endl;
}

// The source files may be compiled as one (UNITY_BUILD).
#undef VolumicSetting
#undef VolumicPrint

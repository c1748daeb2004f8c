// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeformableSurface.h"

#include "AlgorithmErrors.h"
#include "SurfaceSegmentation.h"
#include "VersionCompatibility.h"
#include "WholeInput.h"
#include "vtkImagePyramid.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

vtkStandardNewMacro(vtkDeformableSurface);

namespace
{
/// Share of the progress that the pyramid takes where it is built here.
constexpr double PyramidShare = 0.02;

/// The pyramid of an image, built with default settings. Its errors are thrown.
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImageData* image, vtkInformation* arrayToProcess, int numberOfThreads)
{
  vtkNew<vtkImagePyramid> pyramid;
  pyramid->SetInputData(image);
  pyramid->SetInputArrayToProcess(0, arrayToProcess);
  pyramid->SetNumberOfThreads(numberOfThreads);
  const std::string errors = volumic::UpdateAndCollectErrors(pyramid);
  if (!errors.empty())
  {
    throw std::invalid_argument(errors);
  }
  vtkSmartPointer<vtkMultiBlockDataSet> levels = pyramid->GetOutput();
  return levels;
}

/// Whether this is the first process of a parallel run, or the only one. It makes the whole
/// surface; the others have no output, as they would only repeat it.
bool IsFirstProcess(vtkInformation* request, vtkInformationVector* output)
{
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  return output->GetInformationObject(port)->Get(
           vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) <= 0;
}
}

//------------------------------------------------------------------------------
vtkDeformableSurface::vtkDeformableSurface()
{
  const volumic::SurfaceOptions defaults;
  this->IsoValue = vtkMath::Nan();
  this->ObjectIsBright = defaults.ObjectIsBright;
  this->Initialization = EnclosingIcosahedron;
  this->SeedRadius = defaults.SeedRadius;
  this->CoarsestLevel = -1;
  this->FinestLevel = 0;
  this->SamplingRatio = defaults.SamplingRatio;
  this->TensionWeight = defaults.TensionWeight;
  this->ElasticityWeight = defaults.ElasticityWeight;
  this->IsopotentialWeight = defaults.IsopotentialWeight;
  this->GradientWeight = defaults.GradientWeight;
  this->Friction = defaults.Friction;
  this->BorderValue = static_cast<int>(defaults.BorderValue);
  this->Recovery = defaults.RecoverLostParts ? RecoverObjects : NoRecovery;
  this->MinimumPartSize = defaults.MinimumPartSize;
  this->TopologyChanges = defaults.TopologyChanges;
  this->MaximumNumberOfIterations = defaults.MaximumNumberOfIterations;
  this->ConvergenceTolerance = defaults.ConvergenceTolerance;
  this->FreezeMotionlessVertices = defaults.FreezeMotionlessVertices;
  this->SnapToIsoValue = defaults.SnapToIsoValue;
  this->NumberOfThreads = 0;
  this->Profile = false;

  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkDeformableSurface::~vtkDeformableSurface() = default;

//------------------------------------------------------------------------------
int vtkDeformableSurface::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  }
  else
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkDeformableSurface::FillOutputPortInformation(int port, vtkInformation* info)
{
  const char* types[3] = { "vtkPolyData", "vtkMultiBlockDataSet", "vtkTable" };
  info->Set(vtkDataObject::DATA_TYPE_NAME(), types[port]);
  return 1;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::SetInitialSurfaceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkDeformableSurface::SetInitialSurfaceData(vtkDataObject* data)
{
  this->SetInputDataObject(1, data);
}

vtkMultiBlockDataSet* vtkDeformableSurface::GetLevels()
{
  return vtkMultiBlockDataSet::SafeDownCast(this->GetOutputDataObject(1));
}

vtkTable* vtkDeformableSurface::GetHistory()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  if (!IsFirstProcess(request, output))
  {
    return 1;
  }
  for (int port = 0; port < 2; ++port)
  {
    for (int i = 0; i < input[port]->GetNumberOfInformationObjects(); ++i)
    {
      volumic::AskForWholeInput(input[port]->GetInformationObject(i));
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!IsFirstProcess(request, outputVector))
  {
    return 1;
  }
  try
  {
    vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
    auto* image = vtkImageData::SafeDownCast(input);
    vtkSmartPointer<vtkMultiBlockDataSet> levels = vtkMultiBlockDataSet::SafeDownCast(input);
    if (!image && !levels)
    {
      throw std::invalid_argument("Input port 0: there is neither an image nor a pyramid.");
    }

    volumic::SegmentationSettings settings;
    settings.Options.IsoValue = this->IsoValue;
    settings.Options.ObjectIsBright = this->ObjectIsBright;
    settings.Options.SeedRadius = this->SeedRadius; // still in world units
    settings.Options.SamplingRatio = this->SamplingRatio;
    settings.Options.TensionWeight = this->TensionWeight;
    settings.Options.ElasticityWeight = this->ElasticityWeight;
    settings.Options.IsopotentialWeight = this->IsopotentialWeight;
    settings.Options.GradientWeight = this->GradientWeight;
    settings.Options.Friction = this->Friction;
    settings.Options.MinimumPartSize = this->MinimumPartSize;
    settings.Options.TopologyChanges = this->TopologyChanges;
    settings.Options.MaximumNumberOfIterations = this->MaximumNumberOfIterations;
    settings.Options.ConvergenceTolerance = this->ConvergenceTolerance;
    settings.Options.FreezeMotionlessVertices = this->FreezeMotionlessVertices;
    settings.Options.SnapToIsoValue = this->SnapToIsoValue;
    settings.Initialization = this->Initialization;
    settings.BorderValue = this->BorderValue;
    settings.Recovery = this->Recovery;
    settings.CoarsestLevel = this->CoarsestLevel;
    settings.FinestLevel = this->FinestLevel;
    settings.NumberOfThreads = this->NumberOfThreads;
    settings.Profile = this->Profile;
    settings.InitialSurface = vtkPolyData::GetData(inputVector[1]);

    const double before = image ? PyramidShare : 0.0;
    settings.Progress = [this, before](double share, const std::string& text)
    {
      this->SetProgressText(text.c_str());
      this->UpdateProgress(before + (1.0 - before) * share);
      return !volumic::IsAbortRequested(this);
    };
    settings.Warn = [this](const std::string& text) { vtkWarningMacro(<< text); };
    if (image)
    {
      this->SetProgressText("Building the pyramid");
      this->UpdateProgress(0.0);
      levels = BuildPyramid(image, this->GetInputArrayInformation(0), this->NumberOfThreads);
    }

    volumic::SurfaceSegmentation segmentation(levels, this, settings);
    segmentation.Run();
    vtkPolyData::GetData(outputVector, 0)->ShallowCopy(segmentation.Surface());
    vtkMultiBlockDataSet::GetData(outputVector, 1)->ShallowCopy(segmentation.Levels());
    vtkTable::GetData(outputVector, 2)->ShallowCopy(segmentation.History());
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("Input port 0: the memory does not suffice for the surface. Set FinestLevel to a "
                  "coarser level, or crop the image.");
    return 0;
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsoValue: " << this->IsoValue << endl;
  os << indent << "ObjectIsBright: " << this->ObjectIsBright << endl;
  os << indent << "Initialization: " << this->Initialization << endl;
  os << indent << "SeedRadius: " << this->SeedRadius << endl;
  os << indent << "CoarsestLevel: " << this->CoarsestLevel << endl;
  os << indent << "FinestLevel: " << this->FinestLevel << endl;
  os << indent << "SamplingRatio: " << this->SamplingRatio << endl;
  os << indent << "TensionWeight: " << this->TensionWeight << endl;
  os << indent << "ElasticityWeight: " << this->ElasticityWeight << endl;
  os << indent << "IsopotentialWeight: " << this->IsopotentialWeight << endl;
  os << indent << "GradientWeight: " << this->GradientWeight << endl;
  os << indent << "Friction: " << this->Friction << endl;
  os << indent << "BorderValue: " << this->BorderValue << endl;
  os << indent << "Recovery: " << this->Recovery << endl;
  os << indent << "MinimumPartSize: " << this->MinimumPartSize << endl;
  os << indent << "TopologyChanges: " << this->TopologyChanges << endl;
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << endl;
  os << indent << "ConvergenceTolerance: " << this->ConvergenceTolerance << endl;
  os << indent << "FreezeMotionlessVertices: " << this->FreezeMotionlessVertices << endl;
  os << indent << "SnapToIsoValue: " << this->SnapToIsoValue << endl;
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << endl;
  os << indent << "Profile: " << this->Profile << endl;
}

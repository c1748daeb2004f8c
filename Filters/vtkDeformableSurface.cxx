// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeformableSurface.h"

#include "AlgorithmErrors.h"
#include "BuildPyramid.h"
#include "Core/Common/Refuse.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Deadline.h"
#include "InputImage.h"
#include "SegmentationCache.h"
#include "SurfaceOutput.h"
#include "SurfaceSegmentation.h"
#include "VersionCompatibility.h"
#include "WholeInput.h"
#include "vtkImagePyramid.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

vtkStandardNewMacro(vtkDeformableSurface);

namespace
{
/// Share of the progress that the pyramid takes where it is built here.
constexpr double PyramidShare = 0.02;

vtkSmartPointer<vtkPoints> NewPositions()
{
  auto positions = vtkSmartPointer<vtkPoints>::New();
  positions->SetDataTypeToDouble();
  return positions;
}

void CopyPosition(vtkPoints* positions, int index, double position[3])
{
  if (index >= 0 && index < positions->GetNumberOfPoints())
  {
    positions->GetPoint(index, position);
    return;
  }
  std::fill(position, position + 3, vtkMath::Nan());
}
}

class vtkDeformableSurface::vtkInternals
{
public:
  volumic::SegmentationCache Cache;
  volumic::Deadline Limit; ///< of the run
  bool IsWatched = false;  ///< Someone asks whether a finer level is still to come.
  bool IsOnTheWay = false; ///< One is, and nobody has asked yet.
  bool GoesToTheEnd = false; ///< The next run shows no level before.
};

//------------------------------------------------------------------------------
vtkImageData* vtkDeformableSurface::TakeImage(vtkDataObject* input)
{
  try
  {
    return volumic::ImageOf(input);
  }
  catch (const std::invalid_argument& error)
  {
    volumic::Refuse("Input port 0: ", error.what());
  }
}

//------------------------------------------------------------------------------
vtkDeformableSurface::vtkDeformableSurface()
{
  const volumic::SurfaceOptions defaults;
  this->SelectedComponent = -1;
  this->NaNIsBackground = true;
  this->Metric = World;
  this->EdgeLength = 0.0;
  this->IsoValue = vtkMath::Nan();
  this->ObjectIsBright = defaults.ObjectIsBright;
  this->Initialization = EnclosingIcosahedron;
  this->SeedPositions = NewPositions();
  this->SeedRadius = defaults.SeedRadius;
  this->CoarsestLevel = -1;
  this->FinestLevel = 0;
  this->SamplingRatio = defaults.SamplingRatio;
  this->TensionWeight = defaults.TensionWeight;
  this->ElasticityWeight = defaults.ElasticityWeight;
  this->IsopotentialWeight = defaults.IsopotentialWeight;
  this->GradientWeight = defaults.GradientWeight;
  this->PointAttractionWeight = defaults.PointAttractionWeight;
  this->AttractingPositions = NewPositions();
  this->EdgeAttractionWeight = defaults.EdgeAttractionWeight;
  this->Friction = defaults.Friction;
  this->BorderValue = static_cast<int>(defaults.BorderValue);
  this->Recovery = defaults.RecoverLostParts ? RecoverObjects : NoRecovery;
  this->MinimumPartSize = defaults.MinimumPartSize;
  this->KeepComponents = AllComponents;
  this->MinimumComponentVolume = 0.0;
  this->TopologyChanges = defaults.TopologyChanges;
  this->MaximumNumberOfIterations = defaults.MaximumNumberOfIterations;
  this->ConvergenceTolerance = defaults.ConvergenceTolerance;
  this->FreezeMotionlessVertices = defaults.FreezeMotionlessVertices;
  this->SnapToIsoValue = defaults.SnapToIsoValue;
  this->NumberOfThreads = 0;
  this->TimeLimit = 0.0;
  this->Preview = false;
  this->ShowLevels = false;
  this->Profile = false;
  this->SnapshotInterval = 0;
  this->Internals = std::make_unique<vtkInternals>();

  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(4);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkDeformableSurface::~vtkDeformableSurface() = default;

//------------------------------------------------------------------------------
int vtkDeformableSurface::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
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
  const char* types[4] = { "vtkPolyData", "vtkMultiBlockDataSet", "vtkTable",
    "vtkMultiBlockDataSet" };
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

void vtkDeformableSurface::SetAttractingPointsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkDeformableSurface::SetAttractingPointsData(vtkDataObject* data)
{
  this->SetInputDataObject(2, data);
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::AddSeedPosition(double x, double y, double z)
{
  this->SeedPositions->InsertNextPoint(x, y, z);
  this->Modified();
}

void vtkDeformableSurface::ClearSeedPositions()
{
  this->SeedPositions->SetNumberOfPoints(0);
  this->Modified();
}

int vtkDeformableSurface::GetNumberOfSeedPositions()
{
  return static_cast<int>(this->SeedPositions->GetNumberOfPoints());
}

void vtkDeformableSurface::GetSeedPosition(int index, double position[3])
{
  CopyPosition(this->SeedPositions, index, position);
}

void vtkDeformableSurface::AddAttractingPosition(double x, double y, double z)
{
  this->AttractingPositions->InsertNextPoint(x, y, z);
  this->Modified();
}

void vtkDeformableSurface::ClearAttractingPositions()
{
  this->AttractingPositions->SetNumberOfPoints(0);
  this->Modified();
}

int vtkDeformableSurface::GetNumberOfAttractingPositions()
{
  return static_cast<int>(this->AttractingPositions->GetNumberOfPoints());
}

void vtkDeformableSurface::GetAttractingPosition(int index, double position[3])
{
  CopyPosition(this->AttractingPositions, index, position);
}

//------------------------------------------------------------------------------
vtkMultiBlockDataSet* vtkDeformableSurface::GetLevels()
{
  return vtkMultiBlockDataSet::SafeDownCast(this->GetOutputDataObject(1));
}

vtkTable* vtkDeformableSurface::GetHistory()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

vtkMultiBlockDataSet* vtkDeformableSurface::GetSnapshots()
{
  return vtkMultiBlockDataSet::SafeDownCast(this->GetOutputDataObject(3));
}

//------------------------------------------------------------------------------
template <typename T>
void vtkDeformableSurface::SetForTheEnd(T& property, T value)
{
  if (property != value)
  {
    const vtkMTimeType before = this->GetMTime();
    property = value;
    this->Modified();
    this->Internals->Cache.Allow(before, this->GetMTime());
  }
}

void vtkDeformableSurface::SetFinestLevel(int level)
{
  this->SetForTheEnd(this->FinestLevel, level);
}

void vtkDeformableSurface::SetNumberOfThreads(int number)
{
  this->SetForTheEnd(this->NumberOfThreads, std::max(number, 0));
}

void vtkDeformableSurface::SetTimeLimit(double seconds)
{
  this->SetForTheEnd(this->TimeLimit, seconds);
}

void vtkDeformableSurface::SetPreview(bool preview)
{
  this->SetForTheEnd(this->Preview, preview);
}

void vtkDeformableSurface::SetShowLevels(bool show)
{
  this->SetForTheEnd(this->ShowLevels, show);
}

bool vtkDeformableSurface::GetNeedsUpdate()
{
  vtkInternals& internals = *this->Internals;
  internals.IsWatched = true;
  if (!this->ShowLevels || !internals.IsOnTheWay)
  {
    return false;
  }
  internals.IsOnTheWay = false;
  // The run of level 0 is not kept: level -1 is not reached from there.
  internals.GoesToTheEnd = !internals.Cache.CanGoOn();
  const vtkMTimeType before = this->GetMTime();
  this->Modified();
  internals.Cache.Allow(before, this->GetMTime());
  return true;
}

void vtkDeformableSurface::ForgetRun()
{
  this->Internals->Cache.Drop();
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::AskForWholeInputs(request, input, 3, output);
  return 1;
}

//------------------------------------------------------------------------------
vtkDeformableSurface::Volume vtkDeformableSurface::VolumeAsSet()
{
  Volume volume;
  volume.Selection = this->GetInputArrayInformation(0);
  volume.IsoValue = this->IsoValue;
  volume.FinestLevel = this->FinestLevel;
  volume.SamplingRatio = this->SamplingRatio;
  volume.FactorBelowLevel0 = std::sqrt(3.0);
  volume.EdgeLengthIsPlanned = false;
  volume.LevelsAreOwn = false;
  return volume;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::MakeLevels(
  vtkImagePyramid* pyramid, vtkImageData* image, Volume& volume)
{
  pyramid->SetSelectedComponent(this->SelectedComponent);
  pyramid->SetNaNIsBackground(this->NaNIsBackground);
  pyramid->SetNumberOfThreads(this->NumberOfThreads);
  if (this->EdgeLength != 0.0)
  {
    const volumic::EdgeLengthPlan plan =
      volumic::PlanEdgeLength(this->EdgeLength, this->SamplingRatio, image, pyramid);
    volume.FinestLevel = plan.FinestLevel;
    volume.SamplingRatio = plan.SamplingRatio;
    volume.FactorBelowLevel0 = plan.ReductionFactor;
    volume.EdgeLengthIsPlanned = true;
  }
  volume.LevelsAreOwn = true;
  volume.Levels = volumic::BuildPyramid(pyramid, image, volume.Selection,
    [this](double share) { return this->ShowPyramidProgress(share); });
}

//------------------------------------------------------------------------------
vtkDeformableSurface::Volume vtkDeformableSurface::PrepareVolume(vtkDataObject* input)
{
  Volume volume = this->VolumeAsSet();
  volume.Levels = vtkMultiBlockDataSet::SafeDownCast(input);
  if (!volume.Levels)
  {
    vtkNew<vtkImagePyramid> pyramid;
    this->MakeLevels(pyramid, TakeImage(input), volume);
  }
  return volume;
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::ShowPyramidProgress(double share)
{
  this->SetProgressText("Building the pyramid");
  this->UpdateProgress(PyramidShare * share);
  return !volumic::IsAbortRequested(this) && !this->Internals->Limit.IsOver();
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::ChooseStep(volumic::SegmentationRequest& request, bool isKept)
{
  const bool isWatched = this->ShowLevels && this->Internals->IsWatched;
  if (!isWatched || std::exchange(this->Internals->GoesToTheEnd, false))
  {
    return false;
  }
  const volumic::SegmentationCache& cache = this->Internals->Cache;
  if (!isKept || !cache.CanGoOn())
  {
    request.Preview = true;
    request.IsStep = !this->Preview;
    return request.IsStep;
  }
  const int next = cache.EndOfRun() - 1;
  if (this->EdgeLength != 0.0 || next <= std::max(this->FinestLevel, 0))
  {
    return false;
  }
  request.FinestLevel = next;
  request.IsStep = true;
  return true;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::RunOrGoOn(
  vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::SegmentationSettings settings;
  settings.Started = volumic::Deadline::Clock::now();
  volumic::SegmentationCache& cache = this->Internals->Cache;
  const bool isKept = cache.Serves(this);
  // ParaView leaves the flag of an earlier run as it is.
  volumic::ForgetAbort(this);
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!(this->TimeLimit >= 0.0))
  {
    volumic::Refuse("Time Limit is ", this->TimeLimit, "; it must be 0 (none) or more.");
  }
  this->Internals->Limit = volumic::Deadline(settings.Started, this->TimeLimit);
  vtkDataObject* data = vtkDataObject::GetData(input[0]);
  const double before = vtkMultiBlockDataSet::SafeDownCast(data) ? 0.0 : PyramidShare;

  settings.FinestLevel = this->FinestLevel;
  settings.Preview = this->Preview;
  settings.NumberOfThreads = this->NumberOfThreads;
  settings.InitialSurface = vtkPolyData::GetData(input[1]);
  settings.Limit = this->Internals->Limit;
  settings.Progress = [this, before](double share, const std::string& text)
  {
    this->SetProgressText(text.c_str());
    this->UpdateProgress(before + (1.0 - before) * share);
    return !volumic::IsAbortRequested(this);
  };
  settings.Warn = [this](const std::string& text) { vtkWarningMacro(<< text); };

  const auto warnOf = [&](const volumic::SegmentationResults& results, int end, bool hasRecovery)
  {
    const std::string warning = results.WarningOf(end, hasRecovery && !this->Preview);
    if (!warning.empty())
    {
      settings.Warn(warning);
    }
  };

  this->Internals->IsOnTheWay = false;
  if (isKept)
  {
    if (const volumic::SegmentationResults* results = cache.ResultsFor(settings))
    {
      const int end = cache.EndOf(settings);
      results->FillOutputs(end, output);
      warnOf(*results, end, cache.HasRecovery());
      return;
    }
  }
  const bool isStep = this->ChooseStep(settings, isKept);
  std::unique_ptr<volumic::SurfaceSegmentation> run = isKept ? cache.TakeRun() : nullptr;
  cache.Drop();
  if (run)
  {
    run->Renew(settings);
  }
  else
  {
    if (before > 0.0)
    {
      this->ShowPyramidProgress(0.0); // Whether to stop is asked when there is more to do.
    }
    const Volume volume = this->PrepareVolume(data);
    if (!volume.Levels)
    {
      const bool isAborted = volumic::IsAbortRequested(this) || !settings.Limit.IsOver();
      volumic::SegmentationResults nothing(0, 0, volumic::Workspace(), this->Profile);
      nothing.SetHandedOver(volumic::MakeStopped(
        0, isAborted ? Describe(volumic::StopReason::Cancelled) : volumic::TimeLimitReason));
      nothing.FillOutputs(0, output);
      return;
    }
    settings.FinestLevel = volume.FinestLevel;
    settings.Options.IsoValue = volume.IsoValue;
    settings.Options.ObjectIsBright = this->ObjectIsBright;
    settings.Options.SeedRadius = this->SeedRadius; // still in world units
    settings.Options.SamplingRatio = volume.SamplingRatio;
    settings.Options.TensionWeight = this->TensionWeight;
    settings.Options.ElasticityWeight = this->ElasticityWeight;
    settings.Options.IsopotentialWeight = this->IsopotentialWeight;
    settings.Options.GradientWeight = this->GradientWeight;
    settings.Options.PointAttractionWeight = this->PointAttractionWeight;
    settings.Options.EdgeAttractionWeight = this->EdgeAttractionWeight;
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
    settings.KeepComponents = this->KeepComponents;
    settings.MinimumComponentVolume = this->MinimumComponentVolume;
    settings.CoarsestLevel = this->CoarsestLevel;
    settings.Metric = this->Metric;
    settings.NaNIsBackground = this->NaNIsBackground;
    settings.LevelsAreOwn = volume.LevelsAreOwn;
    settings.EdgeLength = this->EdgeLength;
    settings.EdgeLengthIsPlanned = volume.EdgeLengthIsPlanned;
    settings.FactorBelowLevel0 = volume.FactorBelowLevel0;
    settings.Profile = this->Profile;
    settings.SnapshotInterval = this->SnapshotInterval;
    settings.AttractingPoints = vtkPolyData::GetData(input[2]);
    settings.SeedPositions = this->SeedPositions;
    settings.AttractingPositions = this->AttractingPositions;
    settings.EdgeSelection = this->GetInputArrayInformation(1);
    run = std::make_unique<volumic::SurfaceSegmentation>(volume.Levels, volume.Selection, settings);
  }
  run->Run();
  run->Results().FillOutputs(run->EndsAt(), output);
  const bool isCutOff = settings.Limit.IsOver() || volumic::IsAbortRequested(this);
  const bool isFinest = run->EndsAt() <= this->FinestLevel && this->EdgeLength == 0.0;
  if (isStep && isFinest)
  {
    warnOf(run->Results(), run->EndsAt(), run->GetSettings().Options.RecoverLostParts);
  }
  cache.Keep(std::move(run), this);
  this->Internals->IsOnTheWay = isStep && !isCutOff && !isFinest;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    this->SetErrorCode(vtkErrorCode::NoError);
    return 1;
  }
  try
  {
    this->RunOrGoOn(inputVector, outputVector);
  }
  catch (const std::bad_alloc& error)
  {
    this->ForgetRun();
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro("Input port 0: the memory does not suffice for the surface. Set Finest Level to a "
                  "coarser level, or crop the image.");
  }
  catch (const std::exception& error)
  {
    this->ForgetRun();
    volumic::InitializeOutputs(outputVector);
    this->SetErrorCode(volumic::ErrorCodeOf(error));
    vtkErrorMacro(<< error.what());
  }
  const vtkMTimeType before = this->GetMTime();
  volumic::ForgetAbort(this);
  this->Internals->Cache.Allow(before, this->GetMTime());
  return 1;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "NaNIsBackground: " << this->NaNIsBackground << endl;
  os << indent << "Metric: " << this->Metric << endl;
  os << indent << "EdgeLength: " << this->EdgeLength << endl;
  os << indent << "IsoValue: " << this->IsoValue << endl;
  os << indent << "ObjectIsBright: " << this->ObjectIsBright << endl;
  os << indent << "Initialization: " << this->Initialization << endl;
  os << indent << "SeedPositions: " << this->GetNumberOfSeedPositions() << endl;
  os << indent << "SeedRadius: " << this->SeedRadius << endl;
  os << indent << "CoarsestLevel: " << this->CoarsestLevel << endl;
  os << indent << "FinestLevel: " << this->FinestLevel << endl;
  os << indent << "SamplingRatio: " << this->SamplingRatio << endl;
  os << indent << "TensionWeight: " << this->TensionWeight << endl;
  os << indent << "ElasticityWeight: " << this->ElasticityWeight << endl;
  os << indent << "IsopotentialWeight: " << this->IsopotentialWeight << endl;
  os << indent << "GradientWeight: " << this->GradientWeight << endl;
  os << indent << "PointAttractionWeight: " << this->PointAttractionWeight << endl;
  os << indent << "AttractingPositions: " << this->GetNumberOfAttractingPositions() << endl;
  os << indent << "EdgeAttractionWeight: " << this->EdgeAttractionWeight << endl;
  os << indent << "Friction: " << this->Friction << endl;
  os << indent << "BorderValue: " << this->BorderValue << endl;
  os << indent << "Recovery: " << this->Recovery << endl;
  os << indent << "MinimumPartSize: " << this->MinimumPartSize << endl;
  os << indent << "KeepComponents: " << this->KeepComponents << endl;
  os << indent << "MinimumComponentVolume: " << this->MinimumComponentVolume << endl;
  os << indent << "TopologyChanges: " << this->TopologyChanges << endl;
  os << indent << "MaximumNumberOfIterations: " << this->MaximumNumberOfIterations << endl;
  os << indent << "ConvergenceTolerance: " << this->ConvergenceTolerance << endl;
  os << indent << "FreezeMotionlessVertices: " << this->FreezeMotionlessVertices << endl;
  os << indent << "SnapToIsoValue: " << this->SnapToIsoValue << endl;
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << endl;
  os << indent << "TimeLimit: " << this->TimeLimit << endl;
  os << indent << "Preview: " << this->Preview << endl;
  os << indent << "ShowLevels: " << this->ShowLevels << endl;
  os << indent << "Profile: " << this->Profile << endl;
  os << indent << "SnapshotInterval: " << this->SnapshotInterval << endl;
}

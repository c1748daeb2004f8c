// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeformableSurface.h"

#include "Host/AlgorithmErrors.h"
#include "Host/ControllerRanks.h"
#include "Host/VersionCompatibility.h"
#include "Host/WholeInput.h"
#include "Input/SlabInput.h"
#include "Output/RankOutputs.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkDeformableSurface);

//------------------------------------------------------------------------------
vtkDeformableSurface::vtkDeformableSurface() : Internals(std::make_unique<vtkInternals>(*this))
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(4);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  this->Internals->Controller = vtkMultiProcessController::GetGlobalController();
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
void vtkDeformableSurface::SetController(vtkMultiProcessController* controller)
{
  if (this->Internals->Controller != controller)
  {
    this->Internals->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkDeformableSurface::GetController()
{
  return this->Internals->Controller;
}

//------------------------------------------------------------------------------
bool vtkDeformableSurface::GetNeedsUpdate()
{
  vtkInternals& internals = *this->Internals;
  internals.IsWatched = true;
  if (!internals.Settings.End.ShowLevels || !internals.IsOnTheWay)
  {
    return false;
  }
  internals.IsOnTheWay = false;
  // The run of level 0 is not kept: level -1 is not reached from there.
  internals.GoesToTheEnd = !internals.Cache.CanGoOn();
  this->GoOn();
  return true;
}

void vtkDeformableSurface::SetAbortExecute(vtkTypeBool abort)
{
  // Who presses twice may be heard after the run has ended: that neither makes the filter run again
  // nor others stop.
  this->AbortExecute = abort && this->Internals->Alone;
}

void vtkDeformableSurface::GoOn()
{
  const vtkMTimeType before = this->GetMTime();
  this->Modified();
  this->Internals->Cache.IgnoreChange(before, this->GetMTime());
}

void vtkDeformableSurface::ForgetRun()
{
  this->Internals->Cache.Drop();
  this->Internals->Piece = volumic::HelpersPiece();
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::LeaveCheckpoints()
{
  this->Internals->LeavesCheckpoints = true;
}

void vtkDeformableSurface::RemoveCheckpoint()
{
  if (this->Internals->Checkpoint)
  {
    this->Internals->Checkpoint->Remove();
  }
}

std::string vtkDeformableSurface::GetCheckpointFolder()
{
  return this->Internals->Checkpoint ? this->Internals->Checkpoint->FolderInUse() : "";
}

int vtkDeformableSurface::GetResumedLevel()
{
  constexpr int none = -2;
  return this->Internals->Checkpoint ? this->Internals->Checkpoint->ResumedLevel().value_or(none)
                                     : none;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* output)
{
  // Of what comes from an image ParaView asks for ghosts only where a filter needs them. It knows
  // that by the extent, which a pyramid has not.
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < output->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = output->GetInformationObject(port);
    if (!info->Has(Pipeline::WHOLE_EXTENT()))
    {
      const int none[6] = { 0, -1, 0, -1, 0, -1 };
      info->Set(Pipeline::WHOLE_EXTENT(), none, 6);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const vtkInternals& internals = *this->Internals;
  const auto ranks = volumic::RanksOf(internals.Controller, request, output);
  if (ranks->NumberOfRanks() > 1)
  {
    volumic::AskForPieces(request, input, 3, output, 0);
    return 1;
  }
  volumic::AskForWholeInputs(request, input, 3, output);
  if (internals.Settings.End.MemoryLimit > 0 && volumic::IsFirstProcess(request, output))
  {
    volumic::SlabInput(this).Ask(
      volumic::LimitedMemory::BytesOf(internals.Settings.End.MemoryLimit),
      !internals.Cache.IsValidFor(this, ranks->NumberOfRanks()));
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::Warn(const std::string& text)
{
  std::vector<std::string>& warnings = this->Internals->Warnings;
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end())
  {
    warnings.push_back(text);
  }
}

//------------------------------------------------------------------------------
void vtkDeformableSurface::TellWarnings()
{
  for (const std::string& text : this->Internals->Memory.TakeWarnings())
  {
    this->Warn(text);
  }
  if (this->Internals->IsOnTheWay)
  {
    return;
  }
  for (const std::string& text : std::exchange(this->Internals->Warnings, {}))
  {
    vtkWarningMacro(<< text);
  }
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Internals->Ranks =
    volumic::RanksOf(this->Internals->Controller, request, outputVector);
  volumic::Communicator& ranks = *this->Internals->Ranks;
  if (ranks.NumberOfRanks() == 1 && !volumic::IsFirstProcess(request, outputVector))
  {
    this->SetErrorCode(vtkErrorCode::NoError);
    return 1;
  }
  const auto show = [this](double share, const std::string& text)
  {
    this->SetProgressText(text.c_str());
    this->UpdateProgress(share);
    return !volumic::IsAbortRequested(this);
  };
  this->Internals->Alone = std::make_unique<volumic::FirstRankWork>(ranks, show);
  const volumic::AlgorithmError error = volumic::RunAlgorithm(ranks, outputVector,
    []
    {
      return "Input port 0: the memory does not suffice for the surface. Set Finest Level to a "
             "coarser level, or crop the image.";
    },
    [&]
    {
      this->Internals->RunOrGoOn(inputVector, outputVector);
      volumic::ScatterOutputs(ranks, request, outputVector, this->Internals->Piece.Outputs);
      ranks.IsAny(false); // Who is through with it here hears of no failure any more.
    });
  if (error.Code != vtkErrorCode::NoError)
  {
    this->ForgetRun();
    this->SetErrorCode(error.Code);
    vtkErrorMacro(<< error.Text);
  }
  if (!volumic::SegmentationCache::MayKeep(this))
  {
    this->Internals->Piece = volumic::HelpersPiece();
  }
  this->TellWarnings();
  this->Internals->InitialSurface = nullptr;
  this->Internals->AttractingPoints = nullptr;
  volumic::ForgetAbort(this);
  this->Internals->Alone.reset();
  return 1;
}

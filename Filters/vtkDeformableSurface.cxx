// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeformableSurface.h"

#include "Core/Common/ScratchMemory.h"
#include "Host/Pipeline.h"
#include "Ranks/Ranks.h"
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
  internals.GoesToTheEnd = !internals.Cache.Run() || !internals.Cache.Run()->CanGoOn();
  this->GoOn();
  return true;
}

void vtkDeformableSurface::SetAbortExecute(vtkTypeBool abort)
{
  // Who presses twice may be heard after the run has ended: that neither makes the filter run again
  // nor others stop.
  this->AbortExecute = abort && this->Internals->All;
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
  volumic::Ranks(this->Internals->Controller, { this, request, input, output }).AskForInputs();
  return 1;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& internals = *this->Internals;
  const auto show = [this](double share, const std::string& text)
  {
    this->SetProgressText(text.c_str());
    this->UpdateProgress(share);
    return !volumic::IsAbortRequested(this);
  };
  const volumic::FilterCall call{ this, request, inputVector, outputVector };
  internals.All = std::make_unique<volumic::Ranks>(internals.Controller, call, show);
  volumic::Ranks& ranks = *internals.All;
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!ranks.AreMany() && !volumic::IsFirstProcess(request, outputVector))
  {
    internals.All.reset();
    return 1;
  }
  // ParaView leaves the flag of an earlier run as it is.
  volumic::ForgetAbort(this);
  volumic::RankWork work;
  work.OfFirst = [&]
  {
    const volumic::ScratchMemory scratch(internals.Settings.End.ScratchDirectory);
    internals.RunOrGoOn(call);
  };
  work.OfOthers = [&](volumic::RankMessage&)
  {
    volumic::RankMessage answer;
    answer << internals.Cache.IsValidFor(this, ranks.Count());
    return answer;
  };
  const volumic::AlgorithmError error = ranks.Run(
    []
    {
      return "Input port 0: the memory does not suffice for the surface. Set Finest Level to a "
             "coarser level, or crop the image.";
    },
    work);
  if (error.Code == vtkErrorCode::NoError && !ranks.IsFirst())
  {
    internals.Cache.Keep(nullptr, this, ranks.Count());
  }
  if (error.Code != vtkErrorCode::NoError)
  {
    this->ForgetRun();
    this->SetErrorCode(error.Code);
    vtkErrorMacro(<< error.Text);
  }
  // Not while another run is still to come.
  for (const std::string& text :
    internals.IsOnTheWay ? std::vector<std::string>() : std::exchange(internals.Warnings, {}))
  {
    vtkWarningMacro(<< text);
  }
  volumic::ForgetAbort(this);
  internals.All.reset();
  return 1;
}

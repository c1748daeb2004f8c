// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeformableSurface.h"

#include "Core/Common/ScratchMemory.h"
#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "vtkDeformableSurfaceInternals.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>
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
}

vtkDeformableSurface::~vtkDeformableSurface() = default;

//------------------------------------------------------------------------------
int vtkDeformableSurface::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    // Accept any type, or the pipeline would run the filter once per leaf of a composite dataset.
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
bool vtkDeformableSurface::GetNeedsUpdate()
{
  vtkInternals& internals = *this->Internals;
  internals.IsWatched = true;
  if (!internals.Settings.End.ShowLevels || !internals.IsBetweenLevels)
  {
    return false;
  }
  internals.IsBetweenLevels = false;
  // A run that ended at level 0 is not kept, so level -1 needs a new run.
  internals.RunsToTheEnd = !internals.Kept || !internals.Kept->CanResume();
  this->GoOn();
  return true;
}

vtkSmartPointer<vtkPolyData> vtkDeformableSurface::NewLeftOutComponents()
{
  volumic::HostThreads threads(this->GetNumberOfThreads());
  return this->Internals->Kept ? this->Internals->Kept->LeftOut(threads) : nullptr;
}

void vtkDeformableSurface::SetAbortExecute(vtkTypeBool abort)
{
  // A second request may arrive after the run has ended. It must not make the filter run again, or
  // stop other filters.
  this->AbortExecute = abort && this->Internals->IsRunning;
}

void vtkDeformableSurface::GoOn()
{
  this->Internals->Modify(false);
}

void vtkDeformableSurface::ForgetRun()
{
  this->Internals->ForgetRun();
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::RequestInputs(this, request, input, output);
  return 1;
}

//------------------------------------------------------------------------------
int vtkDeformableSurface::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkInternals& internals = *this->Internals;
  auto* levels = vtkMultiBlockDataSet::GetData(outputVector, 1);
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    internals.MakeEmptyLevels(inputVector[0], levels);
    return 1;
  }
  internals.IsRunning = true;
  internals.IsAlone = volumic::IsOnlyProcess(request, outputVector);
  this->SetErrorCode(volumic::RunAlgorithm(
    this, outputVector, "",
    []
    {
      return "Input port 0: not enough memory for the surface. Set Scratch Directory, set Finest "
             "Level to a coarser level, or crop the image.";
    },
    [&]
    {
      const volumic::ScratchMemory scratch(internals.Settings.End.ScratchDirectory);
      volumic::RunObserver observer(this, internals.Settings.End.TimeLimit, internals.Warnings);
      internals.Update(inputVector, outputVector, observer);
    }));
  internals.IsRunning = false;
  if (!internals.IsAlone && levels->GetNumberOfBlocks() == 0) // after an error or an early stop
  {
    internals.MakeEmptyLevels(inputVector[0], levels);
  }
  if (this->GetErrorCode() != vtkErrorCode::NoError)
  {
    this->ForgetRun();
  }
  // Warn after the last step of several.
  for (const std::string& text :
    internals.IsBetweenLevels ? std::vector<std::string>() : std::exchange(internals.Warnings, {}))
  {
    vtkWarningMacro(<< text);
  }
  return 1;
}

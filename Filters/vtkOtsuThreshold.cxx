// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOtsuThreshold.h"

#include "Host/AlgorithmErrors.h"
#include "Host/ControllerRanks.h"
#include "Host/WholeInput.h"
#include "Input/CellVoxels.h"
#include "Input/InputImage.h"
#include "Input/OtsuThreshold.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <exception>

vtkStandardNewMacro(vtkOtsuThreshold);

//------------------------------------------------------------------------------
vtkOtsuThreshold::vtkOtsuThreshold() : SelectedComponent(-1), Threshold(vtkMath::Nan())
{
  this->Controller = vtkMultiProcessController::GetGlobalController();
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkOtsuThreshold::~vtkOtsuThreshold() = default;

//------------------------------------------------------------------------------
void vtkOtsuThreshold::SetController(vtkMultiProcessController* controller)
{
  if (this->Controller != controller)
  {
    this->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkOtsuThreshold::GetController()
{
  return this->Controller;
}

//------------------------------------------------------------------------------
vtkDoubleArray* vtkOtsuThreshold::GetHistogram()
{
  return this->Histogram;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::FillInputPortInformation(int, vtkInformation* info)
{
  // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  const auto ranks = volumic::RanksOf(this->Controller, request, output);
  if (ranks->NumberOfRanks() > 1)
  {
    volumic::AskForPieces(request, input, 1, output, 0);
    return 1;
  }
  volumic::AskForWholeInputs(request, input, 1, output);
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Threshold = vtkMath::Nan();
  this->Histogram->SetNumberOfTuples(0);
  this->SetErrorCode(vtkErrorCode::NoError);
  const auto ranks = volumic::RanksOf(this->Controller, request, output);
  if (ranks->NumberOfRanks() == 1 && !volumic::IsFirstProcess(request, output))
  {
    return 1;
  }
  const volumic::AlgorithmError error = volumic::RunAlgorithm(*ranks, output,
    [] { return "the memory does not suffice for the threshold."; },
    [&]
    {
      const volumic::PointVoxels voxels = volumic::TakeCellsAsPoints(
        volumic::PieceOfImage(*ranks, vtkDataObject::GetData(input[0])),
        this->GetInputArrayInformation(0));
      const volumic::VoxelHistogram found = volumic::FindOtsuThreshold(
        *ranks, voxels.Image, voxels.Selection, this->SelectedComponent, 0);
      ranks->IsAny(false); // Whoever has failed tells it here at last.
      vtkNew<vtkDoubleArray> column;
      column->SetName("Threshold");
      // One row of them all.
      column->SetNumberOfTuples(ranks->Rank() == 0 ? 1 : 0);
      column->FillValue(found.Threshold);
      vtkTable::GetData(output)->AddColumn(column);
      this->Threshold = found.Threshold;
      this->Histogram->InsertNextValue(found.Range[0]);
      this->Histogram->InsertNextValue(found.Range[1]);
      for (const vtkIdType count : found.Counts)
      {
        this->Histogram->InsertNextValue(static_cast<double>(count));
      }
    });
  if (error.Code != vtkErrorCode::NoError)
  {
    this->SetErrorCode(error.Code);
    vtkErrorMacro("Input port 0: " << error.Text);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkOtsuThreshold::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "Threshold: " << this->Threshold << endl;
}

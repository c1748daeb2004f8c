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
  this->SetErrorCode(vtkErrorCode::NoError);
  const auto ranks = volumic::RanksOf(this->Controller, request, output);
  if (ranks->NumberOfRanks() == 1 && !volumic::IsFirstProcess(request, output))
  {
    return 1;
  }
  try
  {
    const volumic::PointVoxels voxels = volumic::TakeCellsAsPoints(
      volumic::PieceOfImage(*ranks, vtkDataObject::GetData(input[0])),
      this->GetInputArrayInformation(0));
    this->Threshold = volumic::FindOtsuThreshold(
      *ranks, voxels.Image, voxels.Selection, this->SelectedComponent);
    ranks->IsAny(false); // Whoever has failed tells it here at last.
    vtkNew<vtkDoubleArray> column;
    column->SetName("Threshold");
    // One row of them all.
    column->SetNumberOfTuples(ranks->Rank() == 0 ? 1 : 0);
    column->FillValue(this->Threshold);
    vtkTable::GetData(output)->AddColumn(column);
  }
  catch (const volumic::OtherRankFailed& failure)
  {
    this->EndByError(*ranks, volumic::ErrorOf(failure), output);
  }
  catch (const std::exception& error)
  {
    this->EndByError(*ranks, { volumic::ErrorCodeOf(error), error.what() }, output);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkOtsuThreshold::EndByError(volumic::Communicator& ranks,
  const volumic::AlgorithmError& error, vtkInformationVector* output)
{
  ranks.Fail(volumic::ReasonOf(error));
  volumic::InitializeOutputs(output);
  this->Threshold = vtkMath::Nan();
  this->SetErrorCode(error.Code);
  vtkErrorMacro("Input port 0: " << error.Text);
}

//------------------------------------------------------------------------------
void vtkOtsuThreshold::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "Threshold: " << this->Threshold << endl;
}

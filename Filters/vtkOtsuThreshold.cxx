// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOtsuThreshold.h"

#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Input/ValueHints.h"
#include "Ranks/Ranks.h"

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

#include <vector>

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
  volumic::Ranks(this->Controller, { this, request, input, output }).AskForInputs();
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Threshold = vtkMath::Nan();
  this->Histogram->SetNumberOfTuples(0);
  this->SetErrorCode(vtkErrorCode::NoError);
  volumic::Ranks ranks(this->Controller, { this, request, input, output });
  if (!ranks.AreMany() && !volumic::IsFirstProcess(request, output))
  {
    return 1;
  }
  const auto keep = [this](double threshold, const std::vector<double>& histogram)
  {
    this->Threshold = threshold;
    for (const double value : histogram)
    {
      this->Histogram->InsertNextValue(value);
    }
  };
  volumic::RankWork work;
  work.OfFirst = [&]
  {
    const vtkSmartPointer<vtkDataObject> data = ranks.TakeImages(0);
    const volumic::PointVoxels voxels =
      volumic::TakeCellsAsPoints(volumic::ImageOf(data), this->GetInputArrayInformation(0));
    const volumic::VoxelHistogram found =
      volumic::FindOtsuThreshold(voxels.Image, voxels.Selection, this->SelectedComponent, 0);
    vtkNew<vtkDoubleArray> column;
    column->SetName("Threshold");
    column->InsertNextValue(found.Threshold);
    vtkTable::GetData(output)->AddColumn(column);
    std::vector<double> histogram = { found.Range[0], found.Range[1] };
    histogram.insert(histogram.end(), found.Counts.begin(), found.Counts.end());
    keep(found.Threshold, histogram);
    volumic::RankMessage message;
    message << found.Threshold << histogram;
    ranks.AskAll(volumic::RankQuestion::Own, message);
  };
  work.OfOthers = [&keep](volumic::RankMessage& message)
  {
    double threshold = 0.0;
    std::vector<double> histogram;
    message >> threshold >> histogram;
    keep(threshold, histogram);
    return volumic::RankMessage();
  };
  const volumic::AlgorithmError error = ranks.Run(
    [] { return "the memory does not suffice for the threshold."; }, work);
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

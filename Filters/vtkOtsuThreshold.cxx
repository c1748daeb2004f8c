// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOtsuThreshold.h"

#include "Host/Errors.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Input/ValueHints.h"

#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

vtkStandardNewMacro(vtkOtsuThreshold);

//------------------------------------------------------------------------------
vtkOtsuThreshold::vtkOtsuThreshold()
  : SelectedComponent(-1), Threshold(vtkMath::Nan()), BrightThreshold(vtkMath::Nan())
{
}

//------------------------------------------------------------------------------
vtkDoubleArray* vtkOtsuThreshold::GetHistogram()
{
  return this->Histogram;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::FillInputPortInformation(int, vtkInformation* info)
{
  // Accept any type, or the pipeline would run the filter once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::RequestInputs(this, request, input, output);
  return 1;
}

//------------------------------------------------------------------------------
int vtkOtsuThreshold::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Threshold = this->BrightThreshold = vtkMath::Nan();
  this->Histogram->SetNumberOfTuples(0);
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!volumic::IsFirstProcess(request, output))
  {
    return 1;
  }
  const auto work = [&]
  {
    const volumic::PointVoxels voxels = volumic::ConvertCellsToPoints(
      volumic::ImageOf(volumic::WholeInput(input[0])), this->GetInputArrayInformation(0));
    const volumic::VoxelHistogram histogram =
      volumic::FindOtsuThreshold(voxels.Image, voxels.Selection, this->SelectedComponent);
    vtkNew<vtkDoubleArray> column;
    column->SetName("Threshold");
    column->InsertNextValue(histogram.Threshold);
    vtkTable::GetData(output)->AddColumn(column);
    this->Threshold = histogram.Threshold;
    this->BrightThreshold = histogram.BrightThreshold;
    this->Histogram->InsertNextValue(histogram.Range[0]);
    this->Histogram->InsertNextValue(histogram.Range[1]);
    for (const auto count : histogram.Counts)
    {
      this->Histogram->InsertNextValue(static_cast<double>(count));
    }
  };
  this->SetErrorCode(volumic::RunAlgorithm(
    this, output,
    "Input port 0: ", [] { return "not enough memory for the threshold. Crop the image."; }, work));
  return 1;
}

//------------------------------------------------------------------------------
void vtkOtsuThreshold::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SelectedComponent: " << this->SelectedComponent << endl;
  os << indent << "Threshold: " << this->Threshold << endl;
  os << indent << "BrightThreshold: " << this->BrightThreshold << endl;
}

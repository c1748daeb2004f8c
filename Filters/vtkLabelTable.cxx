// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLabelTable.h"

#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Labels/LabelImage.h"
#include "Labels/LabelNames.h"

#include <vtkAbstractArray.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

vtkStandardNewMacro(vtkLabelTable);

//------------------------------------------------------------------------------
int vtkLabelTable::FillInputPortInformation(int, vtkInformation* info)
{
  // Accept any type, or the pipeline would run the filter once per leaf of a composite dataset.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
int vtkLabelTable::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  volumic::RequestInputs(this, request, input, output);
  return 1;
}

//------------------------------------------------------------------------------
int vtkLabelTable::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!volumic::IsFirstProcess(request, outputVector))
  {
    return 1;
  }
  const auto work = [&]
  {
    vtkNew<vtkIntArray> labels;
    vtkNew<vtkStringArray> names;
    vtkNew<vtkIdTypeArray> voxels;
    vtkNew<vtkIntArray> extents;
    vtkNew<vtkDoubleArray> colors;
    const auto addColumn = [&](vtkAbstractArray* column, const char* name, int components)
    {
      column->SetName(name);
      column->SetNumberOfComponents(components);
      vtkTable::GetData(outputVector)->AddColumn(column);
    };
    addColumn(labels, "Label", 1);
    addColumn(names, "Name", 1);
    addColumn(voxels, "Voxels", 1);
    addColumn(extents, "Extent", 6);
    addColumn(colors, "Color", 3);
    vtkDataObject* input = volumic::WholeInput(inputVector[0]);
    volumic::HostThreads threads(0);
    volumic::LabelImage image(input, this->GetInputArrayInformation(0), 0, threads);
    auto labelNames = volumic::LabelNames::Of(volumic::ImageOf(input));
    labelNames.Complete({ image.RenumberedLabels(), {} });
    image.CheckNumberOfLabels();
    for (const auto& entry : image.Labels())
    {
      labels->InsertNextValue(entry.first);
      names->InsertNextValue(labelNames.NameOf(entry.first));
      voxels->InsertNextValue(entry.second.Count);
      extents->InsertNextTypedTuple(entry.second.Extent.data());
      colors->InsertNextTuple(labelNames.ColorOf(entry.first).data());
    }
  };
  this->SetErrorCode(volumic::RunAlgorithm(
    this, outputVector,
    "Input port 0: ", [] { return "not enough memory for the labels. Crop the image."; }, work));
  return 1;
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLabelTable.h"

#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/Pipeline.h"
#include "Input/InputImage.h"
#include "Labels/LabelImage.h"
#include "Labels/LabelNames.h"

#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
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
vtkLabelTable::vtkLabelTable()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkLabelTable::~vtkLabelTable() = default;

//------------------------------------------------------------------------------
int vtkLabelTable::FillInputPortInformation(int, vtkInformation* info)
{
  // Whatever it is: VTK's pipeline would run once per leaf of a composite dataset.
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
  vtkNew<vtkIntArray> labels;
  labels->SetName("Label");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  vtkNew<vtkIdTypeArray> voxels;
  voxels->SetName("Voxels");
  vtkNew<vtkIntArray> extents;
  extents->SetName("Extent");
  extents->SetNumberOfComponents(6);
  vtkNew<vtkDoubleArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(3);
  const auto work = [&]
  {
    vtkDataObject* input = volumic::WholeInput(inputVector[0]);
    volumic::HostThreads threads(0);
    volumic::LabelImage image(input, this->GetInputArrayInformation(0), 0, threads);
    auto known = volumic::LabelNames::Of(volumic::ImageOf(input));
    known.Complete({ image.RenumberedLabels(), {} });
    image.CheckNumberOfLabels();
    for (const auto& entry : image.Labels())
    {
      labels->InsertNextValue(entry.first);
      names->InsertNextValue(known.NameOf(entry.first));
      voxels->InsertNextValue(entry.second.Count);
      extents->InsertNextTypedTuple(entry.second.Extent.data());
      colors->InsertNextTuple(known.ColorOf(entry.first).data());
    }
    vtkTable* table = vtkTable::GetData(outputVector);
    table->AddColumn(labels);
    table->AddColumn(names);
    table->AddColumn(voxels);
    table->AddColumn(extents);
    table->AddColumn(colors);
  };
  this->SetErrorCode(volumic::RunAlgorithm(
    this, outputVector, "Input port 0: ", [] { return "the memory does not suffice for the labels."; }, work));
  return 1;
}

//------------------------------------------------------------------------------
void vtkLabelTable::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicLabelLegend.h"

#include <vtkCompositeDataIterator.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <algorithm>
#include <set>

vtkStandardNewMacro(vtkVolumicLabelLegend);

namespace
{
/** The three columns. */
struct Rows
{
  vtkNew<vtkIntArray> Labels;
  vtkNew<vtkStringArray> Names;
  vtkNew<vtkDoubleArray> Colors;
};

/** Appends the labels of a block that are not there yet. */
void Append(Rows& rows, std::set<int>& known, vtkFieldData* field)
{
  vtkDataArray* labels = field->GetArray("Label");
  vtkDataArray* colors = field->GetArray("LabelColor");
  auto* names = vtkStringArray::SafeDownCast(field->GetAbstractArray("LabelName"));
  if (!labels || !names || !colors || colors->GetNumberOfComponents() != 3)
  {
    return;
  }
  const vtkIdType count = std::min({ labels->GetNumberOfTuples(), names->GetNumberOfTuples(),
    colors->GetNumberOfTuples() });
  for (vtkIdType i = 0; i < count; ++i)
  {
    const int label = static_cast<int>(labels->GetTuple1(i));
    if (known.insert(label).second)
    {
      rows.Labels->InsertNextValue(label);
      rows.Names->InsertNextValue(names->GetValue(i));
      rows.Colors->InsertNextTuple(colors->GetTuple(i));
    }
  }
}
}

//------------------------------------------------------------------------------
vtkVolumicLabelLegend::vtkVolumicLabelLegend() = default;
vtkVolumicLabelLegend::~vtkVolumicLabelLegend() = default;

//------------------------------------------------------------------------------
int vtkVolumicLabelLegend::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkMultiBlockDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkVolumicLabelLegend::RequestData(
  vtkInformation*, vtkInformationVector** input, vtkInformationVector* output)
{
  Rows rows;
  rows.Labels->SetName("Label");
  rows.Names->SetName("Name");
  rows.Colors->SetName("Color");
  rows.Colors->SetNumberOfComponents(3);
  std::set<int> known;
  if (vtkMultiBlockDataSet* blocks = vtkMultiBlockDataSet::GetData(input[0]))
  {
    auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      Append(rows, known, leaf->GetCurrentDataObject()->GetFieldData());
    }
  }
  vtkTable* table = vtkTable::GetData(output);
  table->AddColumn(rows.Labels);
  table->AddColumn(rows.Names);
  table->AddColumn(rows.Colors);
  return 1;
}

//------------------------------------------------------------------------------
vtkIntArray* vtkVolumicLabelLegend::GetLabels()
{
  return vtkIntArray::SafeDownCast(this->GetOutput()->GetColumnByName("Label"));
}

vtkStringArray* vtkVolumicLabelLegend::GetNames()
{
  return vtkStringArray::SafeDownCast(this->GetOutput()->GetColumnByName("Name"));
}

vtkDoubleArray* vtkVolumicLabelLegend::GetColors()
{
  return vtkDoubleArray::SafeDownCast(this->GetOutput()->GetColumnByName("Color"));
}

//------------------------------------------------------------------------------
void vtkVolumicLabelLegend::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicLabelList.h"

#include <vtkCommand.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <set>

vtkStandardNewMacro(vtkVolumicLabelList);

namespace
{
/** Append the labels of a table or of field data that are not in the set of known ones. */
void Append(vtkStringArray* rows, std::set<int>& known, vtkFieldData* data, const char* label,
  const char* name, const char* voxels, const char* color)
{
  vtkDataArray* labels = data->GetArray(label);
  vtkAbstractArray* names = data->GetAbstractArray(name);
  vtkDataArray* counts = data->GetArray(voxels);
  vtkDataArray* colors = data->GetArray(color);
  const vtkIdType count = labels && names && counts && colors ? labels->GetNumberOfTuples() : 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (known.insert(static_cast<int>(labels->GetTuple1(i))).second)
    {
      rows->InsertNextValue(labels->GetVariantValue(i).ToString());
      rows->InsertNextValue(names->GetVariantValue(i).ToString());
      rows->InsertNextValue(
        counts->GetVariantValue(counts->GetNumberOfTuples() == count ? i : 0).ToString());
      for (int c = 0; c < 3; ++c)
      {
        const vtkVariant part = colors->GetVariantValue(3 * i + c);
        rows->InsertNextValue(part.ToString(vtkVariant::DEFAULT_FORMATTING, 17));
      }
    }
  }
}

/** Return TEXT of a message "ERROR: In FILE, line 1\nCLASS (0x1): TEXT\n\n". */
std::string TextOf(const std::string& message)
{
  const std::string end = "): ";
  const std::size_t head = message.find(end), last = message.find_last_not_of(" \n");
  const std::size_t first = head == std::string::npos ? 0 : head + end.size();
  return last == std::string::npos || last < first ? "" : message.substr(first, last + 1 - first);
}
}

//------------------------------------------------------------------------------
vtkVolumicLabelList::vtkVolumicLabelList()
{
  // Observed errors and warnings are not printed.
  this->AddObserver(vtkCommand::ErrorEvent, this, &vtkVolumicLabelList::OnMessage);
  this->AddObserver(vtkCommand::WarningEvent, this, &vtkVolumicLabelList::OnMessage);
}

vtkVolumicLabelList::~vtkVolumicLabelList() = default;

//------------------------------------------------------------------------------
void vtkVolumicLabelList::OnMessage(vtkObject*, unsigned long event, void* text)
{
  if (event == vtkCommand::ErrorEvent && text && this->Problem.empty())
  {
    this->Problem = TextOf(static_cast<const char*>(text));
  }
}

//------------------------------------------------------------------------------
int vtkVolumicLabelList::RequestData(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  this->Problem.clear();
  this->Rows->Initialize();
  std::set<int> known;
  if (auto* blocks = vtkMultiBlockDataSet::GetData(input[0]))
  {
    auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      Append(this->Rows, known, leaf->GetCurrentDataObject()->GetFieldData(), "Label", "LabelName",
        "LabelVoxels", "LabelColor");
    }
  }
  if (known.empty() && this->Superclass::RequestData(request, input, output))
  {
    Append(this->Rows, known, vtkTable::GetData(output)->GetRowData(), "Label", "Name", "Voxels",
      "Color");
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkStringArray* vtkVolumicLabelList::GetRows()
{
  return this->Rows;
}

//------------------------------------------------------------------------------
const char* vtkVolumicLabelList::GetProblem()
{
  return this->Problem.c_str();
}

//------------------------------------------------------------------------------
void vtkVolumicLabelList::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Problem: " << this->Problem << "\n";
}

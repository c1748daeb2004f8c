// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicLabelList.h"

#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

vtkStandardNewMacro(vtkVolumicLabelList);

namespace
{
template <class Array> Array* Column(vtkTable* table, const char* name)
{
  return table ? Array::SafeDownCast(table->GetColumnByName(name)) : nullptr;
}

/** Without what VTK writes about it: "ERROR: In FILE, line 1\nCLASS (0x1): TEXT\n\n". */
std::string TextOf(const std::string& message)
{
  const std::string end = "): ";
  const std::size_t head = message.find(end);
  const std::size_t last = message.find_last_not_of(" \n");
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
  return this->Superclass::RequestData(request, input, output);
}

//------------------------------------------------------------------------------
vtkIntArray* vtkVolumicLabelList::GetLabels()
{
  return Column<vtkIntArray>(this->GetOutput(), "Label");
}

vtkStringArray* vtkVolumicLabelList::GetNames()
{
  return Column<vtkStringArray>(this->GetOutput(), "Name");
}

vtkIdTypeArray* vtkVolumicLabelList::GetVoxels()
{
  return Column<vtkIdTypeArray>(this->GetOutput(), "Voxels");
}

vtkDoubleArray* vtkVolumicLabelList::GetColors()
{
  return Column<vtkDoubleArray>(this->GetOutput(), "Color");
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

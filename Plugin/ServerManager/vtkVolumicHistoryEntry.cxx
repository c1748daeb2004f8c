// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumicHistoryEntry.h"

#include <vtkAlgorithm.h>
#include <vtkInformation.h>
#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkVolumicHistoryEntry);

//------------------------------------------------------------------------------
vtkVolumicHistoryEntry::vtkVolumicHistoryEntry() = default;
vtkVolumicHistoryEntry::~vtkVolumicHistoryEntry() = default;

//------------------------------------------------------------------------------
int vtkVolumicHistoryEntry::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkTable");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//------------------------------------------------------------------------------
void vtkVolumicHistoryEntry::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMSelectedComponentDomain.h"

#include <vtkObjectFactory.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMSelectedComponentDomain);

namespace
{
constexpr int Magnitude = -1;
}

//------------------------------------------------------------------------------
vtkSMSelectedComponentDomain::vtkSMSelectedComponentDomain() = default;
vtkSMSelectedComponentDomain::~vtkSMSelectedComponentDomain() = default;

//------------------------------------------------------------------------------
void vtkSMSelectedComponentDomain::Update(vtkSMProperty*)
{
  std::vector<std::string> names;
  vtkPVDataInformation* data = this->GetInputDataInformation("Input");
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (data && selection)
  {
    vtkSMUncheckedPropertyHelper chosen(selection);
    vtkPVArrayInformation* array = chosen.GetNumberOfElements() < 5
      ? nullptr
      : data->GetArrayInformation(chosen.GetAsString(4), chosen.GetAsInt(3));
    for (int i = 0;
         array && array->GetNumberOfComponents() > 1 && i < array->GetNumberOfComponents(); ++i)
    {
      const char* name = array->GetComponentName(i);
      names.emplace_back(name ? name : std::to_string(i));
    }
  }
  bool isSame = this->GetNumberOfEntries() == names.size() + 1;
  for (unsigned int i = 0; isSame && i < names.size(); ++i)
  {
    isSame = names[i] == this->GetEntryText(i + 1);
  }
  if (isSame)
  {
    return;
  }
  DeferDomainModifiedEvents defer(this);
  this->RemoveAllEntries();
  this->AddEntry("Magnitude", Magnitude);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    this->AddEntry(names[i].c_str(), static_cast<int>(i));
  }
  this->DomainModified();
}

//------------------------------------------------------------------------------
int vtkSMSelectedComponentDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  vtkSMPropertyHelper helper(property);
  helper.SetUseUnchecked(useUncheckedValues);
  helper.Set(Magnitude);
  return 1;
}

//------------------------------------------------------------------------------
void vtkSMSelectedComponentDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMLabelsDomain.h"

#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMProperty.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

vtkStandardNewMacro(vtkSMLabelsDomain);

//------------------------------------------------------------------------------
vtkSMLabelsDomain::vtkSMLabelsDomain() = default;
vtkSMLabelsDomain::~vtkSMLabelsDomain() = default;

//------------------------------------------------------------------------------
bool vtkSMLabelsDomain::Choice::operator==(const Choice& other) const
{
  return this->Producer == other.Producer && this->Port == other.Port &&
    this->Array == other.Array && this->Time == other.Time;
}

//------------------------------------------------------------------------------
vtkSMLabelsDomain::Choice vtkSMLabelsDomain::CurrentChoice()
{
  Choice choice;
  vtkSMProperty* input = this->GetRequiredProperty("Input");
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (!input || !selection)
  {
    return choice;
  }
  vtkSMUncheckedPropertyHelper source(input);
  vtkSMUncheckedPropertyHelper chosen(selection);
  if (source.GetNumberOfElements() > 0)
  {
    choice.Producer = vtkSMSourceProxy::SafeDownCast(source.GetAsProxy());
    choice.Port = source.GetOutputPort();
  }
  for (unsigned int i = 0; chosen.GetNumberOfElements() == 5 && i < 5; ++i)
  {
    const char* text = chosen.GetAsString(i);
    choice.Array[i] = text ? text : "";
  }
  vtkPVDataInformation* data =
    choice.Producer ? choice.Producer->GetDataInformation(choice.Port) : nullptr;
  if (data)
  {
    choice.Time = data->GetMTime();
  }
  else
  {
    choice.Producer = nullptr; // Of one that could not be made there is nothing to know.
  }
  return choice;
}

//------------------------------------------------------------------------------
const volumic::LabelRows& vtkSMLabelsDomain::GetLabels()
{
  Choice choice = this->CurrentChoice();
  if (this->IsCounting || choice == this->Counted)
  {
    return this->Labels;
  }
  this->IsCounting = true;
  this->Labels = choice.Producer
    ? volumic::FetchLabelsOfMap(choice.Producer, choice.Port, choice.Array)
    : volumic::LabelRows();
  this->Counted = this->CurrentChoice();
  this->IsCounting = false;
  return this->Labels;
}

//------------------------------------------------------------------------------
void vtkSMLabelsDomain::Update(vtkSMProperty*)
{
  if (!this->IsCounting && !(this->CurrentChoice() == this->Counted))
  {
    this->DomainModified();
  }
}

//------------------------------------------------------------------------------
void vtkSMLabelsDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Labels: " << this->Labels.Rows.size() << "\n";
  os << indent << "Problem: " << this->Labels.Problem << "\n";
}

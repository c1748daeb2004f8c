// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMLabelsDomain.h"

#include "Helpers.h"

#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSmartPointer.h>
#include <vtkVariant.h>

vtkStandardNewMacro(vtkSMLabelsDomain);

//------------------------------------------------------------------------------
vtkSMLabelsDomain::vtkSMLabelsDomain() = default;
vtkSMLabelsDomain::~vtkSMLabelsDomain() = default;

//------------------------------------------------------------------------------
vtkSMLabelsDomain::Choice vtkSMLabelsDomain::CurrentChoice()
{
  vtkSMProperty* input = this->GetRequiredProperty("Input");
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (!input || !selection)
  {
    return {};
  }
  vtkSMUncheckedPropertyHelper source(input);
  auto* producer = vtkSMSourceProxy::SafeDownCast(
    source.GetNumberOfElements() > 0 ? source.GetAsProxy() : nullptr);
  vtkPVDataInformation* data =
    producer ? producer->GetDataInformation(source.GetOutputPort()) : nullptr;
  if (!data)
  {
    return {}; // the producer could not be created
  }
  vtkSMUncheckedPropertyHelper chosen(selection);
  std::array<std::string, 5> array;
  for (unsigned int i = 0; chosen.GetNumberOfElements() == 5 && i < 5; ++i)
  {
    const char* text = chosen.GetAsString(i);
    array[i] = text ? text : "";
  }
  return { producer, source.GetOutputPort(), array, data->GetMTime() };
}

//------------------------------------------------------------------------------
volumic::LabelRows vtkSMLabelsDomain::FetchLabels(
  vtkSMSourceProxy* producer, unsigned int port, const std::array<std::string, 5>& array)
{
  volumic::LabelRows labels;
  const auto helper = volumic::NewHelper("LabelList", producer, port);
  if (!helper)
  {
    return labels;
  }
  if (!array[4].empty())
  {
    vtkSMPropertyHelper selection(helper, "SetInputArrayToProcess");
    for (unsigned int i = 0; i < array.size(); ++i)
    {
      selection.Set(i, array[i].c_str());
    }
  }
  volumic::RunHelper(helper, producer->GetDataInformation(port));
  vtkSMPropertyHelper texts(helper, "Rows");
  for (unsigned int i = 0; i + 6 <= texts.GetNumberOfElements(); i += 6)
  {
    const auto number = [&](unsigned int column)
    { return vtkVariant(texts.GetAsString(i + column)).ToDouble(); };
    labels.Rows.push_back({ static_cast<int>(number(0)), texts.GetAsString(i + 1),
      static_cast<long long>(number(2)), { { number(3), number(4), number(5) } } });
  }
  labels.Problem = vtkSMPropertyHelper(helper, "Problem").GetAsString();
  return labels;
}

//------------------------------------------------------------------------------
const volumic::LabelRows& vtkSMLabelsDomain::GetLabels()
{
  const Choice choice = this->CurrentChoice();
  if (this->IsFetching || choice == this->Fetched)
  {
    return this->Labels;
  }
  this->IsFetching = true;
  const auto& [producer, port, array, time] = choice;
  this->Labels = producer ? FetchLabels(producer, port, array) : volumic::LabelRows();
  this->Fetched = this->CurrentChoice();
  this->IsFetching = false;
  return this->Labels;
}

//------------------------------------------------------------------------------
void vtkSMLabelsDomain::Update(vtkSMProperty*)
{
  if (!this->IsFetching && this->CurrentChoice() != this->Fetched)
  {
    this->DomainModified();
  }
}

//------------------------------------------------------------------------------
void vtkSMLabelsDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Labels: " << this->Labels.Rows.size() << "\n";
}

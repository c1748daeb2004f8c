// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMOtsuThresholdDomain.h"

#include "Helpers.h"

#include <vtkMath.h>
#include <vtkObjectFactory.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkSMInputProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

vtkStandardNewMacro(vtkSMOtsuThresholdDomain);

namespace
{
/** Return the data information. Update the producer if it has no data yet. */
vtkPVDataInformation* DataOf(vtkSMSourceProxy* producer, unsigned int port)
{
  vtkPVDataInformation* data = producer->GetDataInformation(port);
  if (!data || data->GetNumberOfPoints() == 0)
  {
    producer->UpdatePipeline();
    data = producer->GetDataInformation(port);
  }
  return data;
}

/** Return the array information for the elements of SetInputArrayToProcess, or null. */
vtkPVArrayInformation* ArrayOf(vtkPVDataInformation* data, const std::string array[5])
{
  return data->GetArrayInformation(array[4].c_str(), std::atoi(array[3].c_str()));
}

/** Return whether all voxels are equal. The filter itself reports that as an error. */
bool IsUniform(vtkPVArrayInformation* array, int component)
{
  const double* range =
    array ? array->GetComponentRange(array->GetNumberOfComponents() == 1 ? 0 : component) : nullptr;
  return range && range[0] == range[1];
}
}

//------------------------------------------------------------------------------
vtkSMOtsuThresholdDomain::vtkSMOtsuThresholdDomain() : PresetValue(vtkMath::Nan()) {}

vtkSMOtsuThresholdDomain::~vtkSMOtsuThresholdDomain() = default;

//------------------------------------------------------------------------------
bool vtkSMOtsuThresholdDomain::Choice::operator==(const Choice& other) const
{
  return this->Producer == other.Producer && this->Port == other.Port &&
    this->Component == other.Component &&
    std::equal(std::begin(this->Array), std::end(this->Array), std::begin(other.Array));
}

//------------------------------------------------------------------------------
vtkSMOtsuThresholdDomain::Choice vtkSMOtsuThresholdDomain::CurrentChoice(bool useUnchecked)
{
  Choice choice;
  vtkSMProperty* input = this->GetRequiredProperty("Input");
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (!input || !selection)
  {
    return choice;
  }
  vtkSMPropertyHelper source(input);
  vtkSMPropertyHelper chosen(selection);
  source.SetUseUnchecked(useUnchecked);
  chosen.SetUseUnchecked(useUnchecked);
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
  if (vtkSMProperty* selected = this->GetRequiredProperty("ComponentSelection"))
  {
    vtkSMPropertyHelper component(selected);
    component.SetUseUnchecked(useUnchecked);
    choice.Component = component.GetAsInt();
  }
  return choice;
}

//------------------------------------------------------------------------------
const vtkSMOtsuThresholdDomain::Histogram& vtkSMOtsuThresholdDomain::FindHistogram(
  const Choice& choice, vtkPVDataInformation* data)
{
  if (choice == this->Found && data && data->GetMTime() == this->FoundTime)
  {
    return this->Voxels;
  }
  this->Voxels = Histogram();
  this->Voxels.Threshold = this->Voxels.BrightThreshold = vtkMath::Nan();
  this->Found = choice;
  this->FoundTime = data ? data->GetMTime() : 0;
  vtkSmartPointer<vtkSMSourceProxy> otsu;
  if (data && !IsUniform(ArrayOf(data, choice.Array), choice.Component))
  {
    otsu = volumic::NewHelper("OtsuThreshold", choice.Producer, choice.Port);
  }
  if (!otsu)
  {
    return this->Voxels;
  }
  vtkSMPropertyHelper array(otsu, "SetInputArrayToProcess");
  for (unsigned int i = 0; i < 5; ++i)
  {
    array.Set(i, choice.Array[i].c_str());
  }
  vtkSMPropertyHelper(otsu, "SelectedComponent").Set(choice.Component);
  volumic::RunHelper(otsu, data);
  this->Voxels.Threshold = vtkSMPropertyHelper(otsu, "Threshold").GetAsDouble();
  this->Voxels.BrightThreshold = vtkSMPropertyHelper(otsu, "BrightThreshold").GetAsDouble();
  const std::vector<double> values = vtkSMPropertyHelper(otsu, "Histogram").GetDoubleArray();
  if (values.size() > 2)
  {
    this->Voxels.Low = values[0];
    this->Voxels.High = values[1];
    this->Voxels.Counts.assign(values.begin() + 2, values.end());
  }
  return this->Voxels;
}

//------------------------------------------------------------------------------
const vtkSMOtsuThresholdDomain::Histogram& vtkSMOtsuThresholdDomain::GetHistogram()
{
  const Choice choice = this->CurrentChoice();
  vtkPVDataInformation* data =
    choice.HasArray() ? choice.Producer->GetDataInformation(choice.Port) : nullptr;
  const bool isThere = data && data->GetNumberOfPoints() > 0 && ArrayOf(data, choice.Array);
  return this->FindHistogram(choice, isThere ? data : nullptr);
}

//------------------------------------------------------------------------------
bool vtkSMOtsuThresholdDomain::HasTimeSteps()
{
  const Choice choice = this->CurrentChoice();
  return choice.Producer &&
    choice.Producer->GetDataInformation(choice.Port)->GetNumberOfTimeSteps() > 1;
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::ChooseArray(bool isNewInput)
{
  const Choice choice = this->CurrentChoice();
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (!choice.Producer || (choice.HasArray() && !isNewInput))
  {
    return;
  }
  vtkPVDataInformation* data = DataOf(choice.Producer, choice.Port);
  if (data && !ArrayOf(data, choice.Array))
  {
    selection->ResetToDomainDefaults();
  }
}

//------------------------------------------------------------------------------
int vtkSMOtsuThresholdDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  if (!useUncheckedValues)
  {
    this->ChooseArray(false);
  }
  const Choice choice = this->CurrentChoice();
  const double threshold =
    this->FindHistogram(choice, choice.HasArray() ? DataOf(choice.Producer, choice.Port) : nullptr)
      .Threshold;
  vtkSMPropertyHelper value(property);
  value.SetUseUnchecked(useUncheckedValues);
  int isSet = 1;
  if (std::isnan(threshold))
  {
    isSet = this->Superclass::SetDefaultValues(property, useUncheckedValues);
  }
  else
  {
    value.Set(threshold);
  }
  this->Preset = choice;
  this->PresetValue = value.GetAsDouble();
  return isSet;
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::UpdateRange(const Choice& choice)
{
  vtkPVDataInformation* data =
    choice.HasArray() ? choice.Producer->GetDataInformation(choice.Port) : nullptr;
  const int association = std::atoi(choice.Array[3].c_str());
  vtkPVArrayInformation* array = data ? ArrayOf(data, choice.Array) : nullptr;
  const int count = array ? array->GetNumberOfComponents() : 1;
  if (count > 1)
  {
    // In the superclass the magnitude is the component after the last one.
    this->Superclass::Update(choice.Array[4].c_str(), association, choice.Producer,
      static_cast<int>(choice.Port), choice.Component < 0 ? count : choice.Component);
  }
  else if (choice.HasArray())
  {
    this->Superclass::Update(
      choice.Array[4].c_str(), association, choice.Producer, static_cast<int>(choice.Port), -1);
  }
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::Follow(const Choice& choice)
{
  vtkSMProperty* property = this->GetProperty();
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  vtkSMProxy* filter = property ? property->GetParent() : nullptr;
  const bool wasPreset = this->Preset.HasArray();
  // ParaView presets a new proxy itself.
  if (!filter || !choice.Producer || std::isnan(this->PresetValue) || choice == this->Preset ||
    (!wasPreset && this->Preset.Producer == choice.Producer) ||
    vtkSMUncheckedPropertyHelper(property).GetAsDouble() != this->PresetValue)
  {
    return;
  }
  this->ChooseArray(choice.Producer != this->Preset.Producer);
  const Choice chosen = this->CurrentChoice();
  vtkPVDataInformation* data = DataOf(chosen.Producer, chosen.Port);
  if (!data || !ArrayOf(data, chosen.Array))
  {
    return; // The filter reports the error.
  }
  // Before Apply a panel changes unchecked values only.
  const bool isUnchecked = !(this->CurrentChoice(false) == chosen) ||
    vtkSMPropertyHelper(property).GetAsDouble() != this->PresetValue;
  this->SetDefaultValues(property, isUnchecked);
  if (!isUnchecked && filter->GetObjectsCreated())
  {
    filter->UpdateProperty(filter->GetPropertyName(selection));
    filter->UpdateProperty(filter->GetPropertyName(property));
  }
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::Update(vtkSMProperty*)
{
  this->UpdateRange(this->CurrentChoice());
  if (!this->Following)
  {
    this->Following = true;
    this->Follow(this->CurrentChoice());
    this->Following = false;
    // Other data may have the same range.
    const Choice choice = this->CurrentChoice();
    vtkPVDataInformation* data =
      choice.HasArray() ? choice.Producer->GetDataInformation(choice.Port) : nullptr;
    const vtkMTimeType time = data ? data->GetMTime() : 0;
    if (!(choice == this->Seen) || time != this->SeenTime)
    {
      this->Seen = choice;
      this->SeenTime = time;
      this->DomainModified();
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PresetValue: " << this->PresetValue << endl;
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMOtsuThresholdDomain.h"

#include <vtkMath.h>
#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMInputProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSmartPointer.h>

#include <cmath>

vtkStandardNewMacro(vtkSMOtsuThresholdDomain);

//------------------------------------------------------------------------------
vtkSMOtsuThresholdDomain::vtkSMOtsuThresholdDomain() = default;
vtkSMOtsuThresholdDomain::~vtkSMOtsuThresholdDomain() = default;

//------------------------------------------------------------------------------
double vtkSMOtsuThresholdDomain::ComputeThreshold()
{
  vtkSMProperty* input = this->GetRequiredProperty("Input");
  vtkSMProperty* selection = this->GetRequiredProperty("ArraySelection");
  if (!input || !selection)
  {
    return vtkMath::Nan();
  }
  vtkSMUncheckedPropertyHelper source(input);
  vtkSMUncheckedPropertyHelper chosen(selection);
  auto* producer = vtkSMSourceProxy::SafeDownCast(
    source.GetNumberOfElements() > 0 ? source.GetAsProxy() : nullptr);
  // Before the data is known there is no array to choose.
  if (!producer || chosen.GetNumberOfElements() < 5 || !*chosen.GetAsString(4))
  {
    return vtkMath::Nan();
  }
  auto otsu = vtkSmartPointer<vtkSMProxy>::Take(
    producer->GetSessionProxyManager()->NewProxy("internal_filters", "OtsuThreshold"));
  auto* filter = vtkSMSourceProxy::SafeDownCast(otsu);
  if (!filter)
  {
    return vtkMath::Nan();
  }
  filter->SetLocation(producer->GetLocation());
  vtkSMPropertyHelper(filter, "Input").Set(producer, source.GetOutputPort());
  vtkSMPropertyHelper array(filter, "SetInputArrayToProcess");
  for (unsigned int i = 0; i < 5; ++i)
  {
    array.Set(i, chosen.GetAsString(i));
  }
  filter->UpdateVTKObjects();
  // At the time that is shown, so that nothing before has to run again.
  vtkPVDataInformation* data = producer->GetDataInformation(source.GetOutputPort());
  if (data && data->GetHasTime())
  {
    filter->UpdatePipeline(data->GetTime());
  }
  else
  {
    filter->UpdatePipeline();
  }
  filter->UpdatePropertyInformation();
  return vtkSMPropertyHelper(filter, "Threshold").GetAsDouble();
}

//------------------------------------------------------------------------------
int vtkSMOtsuThresholdDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  const double threshold = this->ComputeThreshold();
  if (std::isnan(threshold))
  {
    return this->Superclass::SetDefaultValues(property, useUncheckedValues);
  }
  if (useUncheckedValues)
  {
    vtkSMUncheckedPropertyHelper(property).Set(threshold);
  }
  else
  {
    vtkSMPropertyHelper(property).Set(threshold);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkSMOtsuThresholdDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

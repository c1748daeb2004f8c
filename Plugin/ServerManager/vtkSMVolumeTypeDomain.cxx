// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMVolumeTypeDomain.h"

#include <vtkObjectFactory.h>
#include <vtkPVDataInformation.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

vtkStandardNewMacro(vtkSMVolumeTypeDomain);

//------------------------------------------------------------------------------
vtkSMVolumeTypeDomain::vtkSMVolumeTypeDomain() = default;
vtkSMVolumeTypeDomain::~vtkSMVolumeTypeDomain() = default;

//------------------------------------------------------------------------------
int vtkSMVolumeTypeDomain::IsInDomain(vtkSMProperty* property)
{
  if (!property)
  {
    return vtkSMDomain::NOT_IN_DOMAIN;
  }
  vtkSMUncheckedPropertyHelper inputs(property);
  for (unsigned int i = 0; i < inputs.GetNumberOfElements(); ++i)
  {
    auto* producer = vtkSMSourceProxy::SafeDownCast(inputs.GetAsProxy(i));
    vtkPVDataInformation* data =
      producer ? producer->GetDataInformation(inputs.GetOutputPort(i)) : nullptr;
    if (data &&
      (data->DataSetTypeIsA("vtkOverlappingAMR") || data->DataSetTypeIsA("vtkNonOverlappingAMR")))
    {
      return vtkSMDomain::NOT_IN_DOMAIN;
    }
  }
  return this->Superclass::IsInDomain(property);
}

//------------------------------------------------------------------------------
void vtkSMVolumeTypeDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

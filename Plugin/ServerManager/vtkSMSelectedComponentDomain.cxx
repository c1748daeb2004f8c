// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMSelectedComponentDomain.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSMSelectedComponentDomain);

//------------------------------------------------------------------------------
void vtkSMSelectedComponentDomain::Update(vtkSMProperty* requestingProperty)
{
  DeferDomainModifiedEvents defer(this);
  this->RemoveAllEntries();
  this->Superclass::Update(requestingProperty);
  this->AddEntry("Magnitude", -1);
  this->DomainModified();
}

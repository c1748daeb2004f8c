// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Helpers.h"

#include <vtkPVDataInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionProxyManager.h>

namespace volumic
{
//------------------------------------------------------------------------------
vtkSmartPointer<vtkSMSourceProxy> NewHelper(
  const char* name, vtkSMSourceProxy* producer, unsigned int port)
{
  auto proxy = vtkSmartPointer<vtkSMProxy>::Take(
    producer->GetSessionProxyManager()->NewProxy("internal_filters", name));
  vtkSmartPointer<vtkSMSourceProxy> helper = vtkSMSourceProxy::SafeDownCast(proxy);
  if (helper)
  {
    helper->SetLocation(producer->GetLocation());
    vtkSMPropertyHelper(helper, "Input").Set(producer, port);
  }
  return helper;
}

//------------------------------------------------------------------------------
void RunHelper(vtkSMSourceProxy* helper, vtkPVDataInformation* data)
{
  helper->UpdateVTKObjects();
  if (data && data->GetHasTime())
  {
    helper->UpdatePipeline(data->GetTime());
  }
  else
  {
    helper->UpdatePipeline();
  }
  helper->UpdatePropertyInformation();
}
}

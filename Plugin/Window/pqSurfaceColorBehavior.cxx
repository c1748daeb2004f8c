// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqSurfaceColorBehavior.h"

#include "SurfaceSources.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqServerManagerModel.h>

#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

//------------------------------------------------------------------------------
pqSurfaceColorBehavior::pqSurfaceColorBehavior() = default;
pqSurfaceColorBehavior::~pqSurfaceColorBehavior() = default;

//------------------------------------------------------------------------------
void pqSurfaceColorBehavior::startup()
{
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(representationAdded(pqRepresentation*)), SLOT(giveColor(pqRepresentation*)));
}

//------------------------------------------------------------------------------
void pqSurfaceColorBehavior::shutdown()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    core->getServerManagerModel()->disconnect(this);
  }
}

//------------------------------------------------------------------------------
void pqSurfaceColorBehavior::giveColor(pqRepresentation* display)
{
  // The display itself does not know yet of what it is.
  vtkSMProxy* shown = display->getProxy();
  vtkSMProxy* of = vtkSMPropertyHelper(shown, "Input", true).GetAsProxy();
  auto* filter =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineFilter*>(of);
  pqOutputPort* input = filter && !filter->getAllInputs().isEmpty()
    ? filter->getAllInputs().first()
    : nullptr;
  pqDataRepresentation* former = input && volumic::IsOfSurface(input->getSource())
    ? input->getRepresentation(pqActiveObjects::instance().activeView())
    : nullptr;
  // What a saved state brings has its colours.
  if (!former || pqApplicationCore::instance()->isLoadingState())
  {
    return;
  }
  for (const char* name : { "AmbientColor", "DiffuseColor", "Specular", "SpecularPower" })
  {
    vtkSMProperty* from = former->getProxy()->GetProperty(name);
    vtkSMProperty* to = shown->GetProperty(name);
    if (from && to)
    {
      to->Copy(from);
    }
  }
  shown->UpdateVTKObjects();
}

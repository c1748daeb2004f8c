// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqLabelLegendBehavior.h"

#include "SurfaceSources.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqPropertiesPanel.h>
#include <pqServerManagerModel.h>
#include <pqView.h>

#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>

#include <QTimer>

//------------------------------------------------------------------------------
void pqLabelLegendBehavior::startup()
{
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(representationAdded(pqRepresentation*)), SLOT(add(pqRepresentation*)));
  QTimer::singleShot(0, this, SLOT(watchPanels()));
}

//------------------------------------------------------------------------------
void pqLabelLegendBehavior::shutdown()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    core->getServerManagerModel()->disconnect(this);
  }
}

//------------------------------------------------------------------------------
void pqLabelLegendBehavior::watchPanels()
{
  for (pqPropertiesPanel* panel : volumic::PropertiesPanels())
  {
    this->connect(panel, SIGNAL(applied(pqProxy*)), SLOT(hideLegends()));
  }
}

//------------------------------------------------------------------------------
void pqLabelLegendBehavior::add(pqRepresentation* display)
{
  // The display has no input and no view yet.
  vtkSMProxy* of = vtkSMPropertyHelper(display->getProxy(), "Input", true).GetAsProxy();
  auto* filter =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineFilter*>(of);
  pqOutputPort* input =
    filter && !filter->getAllInputs().isEmpty() ? filter->getAllInputs().first() : nullptr;
  pqView* view = pqActiveObjects::instance().activeView();
  pqDataRepresentation* former = view && input && volumic::IsDownstreamOfSurface(input->getSource())
    ? input->getRepresentation(view)
    : nullptr;
  auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(former ? former->getProxy() : nullptr);
  if (proxy && proxy->GetUsingScalarColoring() && !proxy->IsScalarBarVisible(view->getProxy()))
  {
    this->WithoutLegend.append(qobject_cast<pqDataRepresentation*>(display));
  }
}

//------------------------------------------------------------------------------
void pqLabelLegendBehavior::hideLegends()
{
  for (pqDataRepresentation* display : this->WithoutLegend)
  {
    auto* proxy = vtkSMPVRepresentationProxy::SafeDownCast(display ? display->getProxy() : nullptr);
    if (proxy && display->getView())
    {
      proxy->SetScalarBarVisibility(display->getView()->getProxy(), false);
    }
  }
  this->WithoutLegend.clear();
}

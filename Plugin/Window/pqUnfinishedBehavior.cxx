// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqUnfinishedBehavior.h"

#include "SurfaceSources.h"

#include <pqApplicationCore.h>
#include <pqPropertiesPanel.h>
#include <pqServerManagerModel.h>

#include <vtkPVGeneralSettings.h>
#include <vtkSMOutputPort.h>
#include <vtkSMSourceProxy.h>

#include <QTimer>

//------------------------------------------------------------------------------
pqUnfinishedBehavior::pqUnfinishedBehavior() = default;
pqUnfinishedBehavior::~pqUnfinishedBehavior() = default;

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::startup()
{
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(look(pqPipelineSource*)));
  QTimer::singleShot(0, this, SLOT(watchPanels()));
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::shutdown()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    core->getServerManagerModel()->disconnect(this);
  }
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::watchPanels()
{
  for (pqPropertiesPanel* panel : volumic::PropertiesPanels())
  {
    this->connect(panel, SIGNAL(applied(pqProxy*)), SLOT(goOn(pqProxy*)));
  }
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::look(pqPipelineSource* source)
{
  // Once Apply, which may be what has run it, is through with it.
  const QPointer<pqPipelineSource> seen = source;
  QTimer::singleShot(0, this,
    [this, seen]
    {
      auto* proxy = vtkSMSourceProxy::SafeDownCast(seen ? seen->getProxy() : nullptr);
      this->Unfinished.removeAll(seen);
      if (proxy && proxy->GetOutputPortsCreated() && volumic::GivesSurfaces(seen) &&
        !vtkPVGeneralSettings::GetInstance()->GetAutoApply() &&
        !volumic::WhyUnfinished(proxy->GetOutputPort(0u)->GetDataInformation()).empty())
      {
        this->Unfinished.append(seen);
        seen->setModifiedState(pqProxy::MODIFIED);
      }
    });
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::goOn(pqProxy* applied)
{
  auto* source = qobject_cast<pqPipelineSource*>(applied);
  if (source && this->Unfinished.removeAll(source) > 0)
  {
    source->getProxy()->InvokeCommand("GoOn");
    source->getProxy()->MarkModified(source->getProxy());
    source->renderAllViews();
  }
}

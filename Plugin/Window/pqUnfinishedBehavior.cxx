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
    SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(onDataUpdated(pqPipelineSource*)));
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
    this->connect(panel, SIGNAL(applied(pqProxy*)), SLOT(resume(pqProxy*)));
  }
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::onDataUpdated(pqPipelineSource* source)
{
  // After Apply, which may have run the source.
  const QPointer<pqPipelineSource> updated = source;
  QTimer::singleShot(0, this,
    [this, updated]
    {
      auto* proxy = vtkSMSourceProxy::SafeDownCast(updated ? updated->getProxy() : nullptr);
      this->Unfinished.removeAll(updated);
      if (proxy && proxy->GetOutputPortsCreated() && volumic::ProducesSurfaces(updated) &&
        !vtkPVGeneralSettings::GetInstance()->GetAutoApply() &&
        !volumic::UnfinishedReason(proxy->GetOutputPort(0u)->GetDataInformation()).empty())
      {
        this->Unfinished.append(updated);
        updated->setModifiedState(pqProxy::MODIFIED);
      }
    });
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::resume(pqProxy* applied)
{
  auto* source = qobject_cast<pqPipelineSource*>(applied);
  if (source && this->Unfinished.removeAll(source) > 0)
  {
    source->getProxy()->InvokeCommand("GoOn");
    source->getProxy()->MarkModified(source->getProxy());
    source->renderAllViews();
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqUnfinishedBehavior.h"

#include "SurfaceSources.h"

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPropertiesPanel.h>
#include <pqServerManagerModel.h>

#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVGeneralSettings.h>
#include <vtkSMOutputPort.h>
#include <vtkSMSourceProxy.h>

#include <QTimer>
#include <QWidget>

#include <string>

namespace
{
bool isUnfinished(vtkSMSourceProxy* source)
{
  vtkPVDataInformation* data = source->GetOutputPort(0u)->GetDataInformation();
  vtkPVArrayInformation* reasons = data->GetArrayInformation("StopReason", vtkDataObject::FIELD);
  for (int i = 0; reasons && i < reasons->GetNumberOfStringValues(); ++i)
  {
    const std::string reason = reasons->GetStringValue(i);
    if (reason == "cancelled" || reason == "time limit")
    {
      return true;
    }
  }
  return false;
}
}

//------------------------------------------------------------------------------
pqUnfinishedBehavior::pqUnfinishedBehavior() = default;
pqUnfinishedBehavior::~pqUnfinishedBehavior() = default;

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::startup()
{
  this->connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(dataUpdated(pqPipelineSource*)), SLOT(look(pqPipelineSource*)));
  // Of a plugin that is loaded at the start the window has no panels yet.
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
  QWidget* window = pqCoreUtilities::mainWidget();
  for (auto* panel : window ? window->findChildren<pqPropertiesPanel*>()
                            : QList<pqPropertiesPanel*>())
  {
    this->connect(panel, SIGNAL(applied(pqProxy*)), SLOT(runAgain(pqProxy*)));
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
        !vtkPVGeneralSettings::GetInstance()->GetAutoApply() && isUnfinished(proxy))
      {
        this->Unfinished.append(seen);
        seen->setModifiedState(pqProxy::MODIFIED);
      }
    });
}

//------------------------------------------------------------------------------
void pqUnfinishedBehavior::runAgain(pqProxy* applied)
{
  auto* source = qobject_cast<pqPipelineSource*>(applied);
  auto* filter = source
    ? vtkAlgorithm::SafeDownCast(source->getProxy()->GetClientSideObject())
    : nullptr;
  if (filter && this->Unfinished.removeAll(source) > 0)
  {
    filter->Modified();
    source->getProxy()->MarkModified(source->getProxy());
    source->renderAllViews();
  }
}

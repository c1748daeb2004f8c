// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqAbortButtonBehavior.h"

#include <pqApplicationCore.h>
#include <pqCoreConfiguration.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqProgressManager.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkSMProxy.h>

#include <QAbstractButton>
#include <QCoreApplication>
#include <QEvent>
#include <QMouseEvent>
#include <QWidget>
#include <QWindow>

namespace
{
/** How often events are looked for, as in ParaView 6.1. */
constexpr qint64 MillisecondsBetweenEvents = 100;

pqProgressManager* progressManager()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getProgressManager() : nullptr;
}

/** ParaView's own, which is the one thing that may be pressed while something runs. */
QAbstractButton* findAbortButton()
{
  for (const QPointer<QObject>& object : progressManager()->nonBlockableObjects())
  {
    if (auto* button = qobject_cast<QAbstractButton*>(object.data()))
    {
      return button;
    }
  }
  return nullptr;
}

QPoint placeOf(const QMouseEvent* event)
{
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  return event->globalPos();
#else
  return event->globalPosition().toPoint();
#endif
}

/**
 * What a user does to the window. A button of the mouse may always be let go, and the mouse moved.
 */
bool isInput(const QEvent* event)
{
  switch (event->type())
  {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
    case QEvent::Wheel:
    case QEvent::ContextMenu:
    case QEvent::KeyPress:
    case QEvent::ShortcutOverride:
    case QEvent::Shortcut:
    case QEvent::DragEnter:
    case QEvent::Drop:
    case QEvent::Close:
      return true;
    case QEvent::MouseMove:
      return static_cast<const QMouseEvent*>(event)->buttons() != Qt::NoButton;
    default:
      return false;
  }
}

/**
 * ParaView's timers apply, render and look for new data. One whose event is swallowed comes again.
 */
bool isTimerOfParaView(const QObject* object, const QEvent* event)
{
  return event->type() == QEvent::Timer && object->inherits("pqTimer");
}
}

//------------------------------------------------------------------------------
pqAbortButtonBehavior::pqAbortButtonBehavior() = default;
pqAbortButtonBehavior::~pqAbortButtonBehavior() = default;

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::startup()
{
  pqServerManagerModel* model = pqApplicationCore::instance()->getServerManagerModel();
  this->connect(
    model, SIGNAL(sourceAdded(pqPipelineSource*)), SLOT(watch(pqPipelineSource*)));
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    this->watch(source);
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::shutdown()
{
  this->onEnd();
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    core->getServerManagerModel()->disconnect(this);
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::watch(pqPipelineSource* source)
{
  vtkSMProxy* proxy = source->getProxy();
  auto* filter = vtkAlgorithm::SafeDownCast(proxy ? proxy->GetClientSideObject() : nullptr);
  if (filter &&
    (filter->IsA("vtkDeformableSurface") || filter->IsA("vtkImagePyramid") ||
      filter->IsA("vtkLabelsToSurfaces")))
  {
    pqCoreUtilities::connect(filter, vtkCommand::StartEvent, this, SLOT(onStart(vtkObject*)));
    pqCoreUtilities::connect(filter, vtkCommand::ProgressEvent, this, SLOT(onProgress()));
    pqCoreUtilities::connect(filter, vtkCommand::EndEvent, this, SLOT(onEnd()));
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::onStart(vtkObject* filter)
{
  this->Button = findAbortButton();
  pqServer* server = pqApplicationCore::instance()->getActiveServer();
  // While tests are played, ParaView 6.1 doesn't look for events either.
  if (!this->Button || !server || !server->isProgressPending() ||
    pqCoreConfiguration::instance()->testScriptCount() > 0)
  {
    return;
  }
  this->Running = vtkAlgorithm::SafeDownCast(filter);
  this->connect(this->Button, SIGNAL(pressed()), SLOT(stop()), Qt::UniqueConnection);
  QCoreApplication::instance()->installEventFilter(this);
  this->SinceEvents.start();
  if (!this->Button->isEnabled())
  {
    this->IsLit = true;
    progressManager()->setEnableAbort(true);
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::onProgress()
{
  if (this->Running && this->IsLit && !this->IsLooking &&
    this->SinceEvents.elapsed() >= MillisecondsBetweenEvents)
  {
    this->IsLooking = true;
    pqCoreUtilities::processEvents();
    this->IsLooking = false;
    this->SinceEvents.start();
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::onEnd()
{
  QCoreApplication::instance()->removeEventFilter(this);
  this->Running = nullptr;
  pqProgressManager* manager = progressManager();
  if (this->Button && manager)
  {
    manager->removeNonBlockableObject(this->Button->window()->windowHandle());
    if (this->IsLit)
    {
      manager->setEnableAbort(false);
    }
  }
  this->IsLit = false;
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::stop()
{
  if (this->Running)
  {
    this->Running->SetAbortExecute(1);
  }
}

//------------------------------------------------------------------------------
bool pqAbortButtonBehavior::isPressOfButton(QObject* object, QEvent* event) const
{
  if (!this->Button || event->type() != QEvent::MouseButtonPress)
  {
    return false;
  }
  const QPoint place = this->Button->mapFromGlobal(placeOf(static_cast<QMouseEvent*>(event)));
  return (object == this->Button || object == this->Button->window()->windowHandle()) &&
    this->Button->rect().contains(place);
}

//------------------------------------------------------------------------------
bool pqAbortButtonBehavior::eventFilter(QObject* object, QEvent* event)
{
  if (isTimerOfParaView(object, event))
  {
    return true;
  }
  if (!isInput(event))
  {
    return this->QObject::eventFilter(object, event);
  }
  if (this->isPressOfButton(object, event))
  {
    if (object != this->Button)
    {
      // ParaView's own filter of events, which comes next, looks at this list.
      progressManager()->addNonBlockableObject(object);
    }
    return false;
  }
  event->ignore();
  return true;
}

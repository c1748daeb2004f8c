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
#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QMainWindow>
#include <QMouseEvent>
#include <QStatusBar>
#include <QTimer>
#include <QWindow>

#include <algorithm>

namespace
{
/** Limits of the pause between two updates of the window, in milliseconds. */
constexpr qint64 MinimumPause = 200;
constexpr qint64 MaximumPause = 1000;
/** The pause is this many times the duration of the last update. */
constexpr qint64 PausePerUpdate = 10;

pqProgressManager* progressManager()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getProgressManager() : nullptr;
}

QMainWindow* mainWindow()
{
  return qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

/** Return ParaView's abort button, the only widget that may be pressed during a run. */
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

QPoint positionOf(const QMouseEvent* event)
{
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  return event->globalPos();
#else
  return event->globalPosition().toPoint();
#endif
}

/** Return whether the event is input. Moves and releases of the mouse start nothing. */
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

/** Return whether the user quits by the keyboard, or closes the main window. */
bool isQuit(const QObject* object, QEvent* event)
{
  const QMainWindow* window = mainWindow();
  switch (event->type())
  {
    case QEvent::KeyPress:
    case QEvent::ShortcutOverride:
      return static_cast<QKeyEvent*>(event)->matches(QKeySequence::Quit);
    case QEvent::Close:
      return window && (object == window || object == window->windowHandle());
    default:
      return false;
  }
}

/**
 * Return whether the event is of a timer of ParaView: they apply, render and check for new data. If
 * an event is filtered out, the timer repeats it.
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
  this->connect(model, SIGNAL(sourceAdded(pqPipelineSource*)), SLOT(watch(pqPipelineSource*)));
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
  // During playback of tests, ParaView 6.1 does not process events either.
  if (!this->Button || !server || !server->isProgressPending() ||
    pqCoreConfiguration::instance()->testScriptCount() > 0)
  {
    return;
  }
  this->Running = vtkAlgorithm::SafeDownCast(filter);
  this->connect(this->Button, SIGNAL(pressed()), SLOT(stop()), Qt::UniqueConnection);
  // With a native window, the progress bar is redrawn without the 3D views.
  QWidget* bar = this->Button->parentWidget();
  bar->setAttribute(Qt::WA_DontCreateNativeAncestors);
  bar->setAttribute(Qt::WA_NativeWindow);
  pqProgressManager* manager = progressManager();
  if (!this->Button->isEnabled())
  {
    this->HasEnabledButton = true;
    manager->setEnableAbort(true);
  }
  // The manager then ignores ParaView's more frequent reports, and does not block input.
  manager->lockProgress(this);
  manager->unblockEvents(true);
  this->connect(this, SIGNAL(progress(const QString&, int)), manager,
    SLOT(setProgress(const QString&, int)), Qt::UniqueConnection);
  QCoreApplication::instance()->installEventFilter(this);
  this->Pause = MinimumPause;
  this->SinceUpdate.start();
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::onProgress()
{
  if (!this->Running || this->IsUpdating || this->SinceUpdate.elapsed() < this->Pause)
  {
    return;
  }
  this->IsUpdating = true;
  this->SinceUpdate.start();
  Q_EMIT this->progress(
    this->Running->GetProgressText(), static_cast<int>(100.0 * this->Running->GetProgress()));
  pqCoreUtilities::processEvents();
  this->Pause =
    std::clamp(PausePerUpdate * this->SinceUpdate.restart(), MinimumPause, MaximumPause);
  this->IsUpdating = false;
  if (this->IsQuitting)
  {
    this->stop();
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::onEnd()
{
  if (!this->Running)
  {
    return;
  }
  QCoreApplication::instance()->removeEventFilter(this);
  this->Running = nullptr;
  if (QMainWindow* window = mainWindow())
  {
    window->statusBar()->clearMessage();
  }
  if (pqProgressManager* manager = progressManager())
  {
    manager->unlockProgress(this);
    manager->unblockEvents(false);
    if (this->HasEnabledButton)
    {
      manager->setEnableAbort(false);
    }
  }
  this->HasEnabledButton = false;
  if (this->IsQuitting)
  {
    this->quit();
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::quit()
{
  pqServer* server = pqApplicationCore::instance()->getActiveServer();
  if (server && server->isProgressPending())
  {
    QTimer::singleShot(static_cast<int>(MinimumPause), this, SLOT(quit()));
    return;
  }
  this->IsQuitting = false;
  QApplication::closeAllWindows(); // as File > Exit does
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
  const QPoint position = this->Button->mapFromGlobal(positionOf(static_cast<QMouseEvent*>(event)));
  return (object == this->Button || object == this->Button->parentWidget()->windowHandle()) &&
    this->Button->rect().contains(position);
}

//------------------------------------------------------------------------------
bool pqAbortButtonBehavior::eventFilter(QObject* object, QEvent* event)
{
  // ParaView 6.1 would set a cursor, and at the end of the run restore the busy one.
  if (isTimerOfParaView(object, event) ||
    (event->type() == QEvent::Enter && this->Button && object == this->Button->parent()))
  {
    return true;
  }
  if (!isInput(event) || this->isPressOfButton(object, event))
  {
    return false;
  }
  this->IsQuitting = this->IsQuitting || isQuit(object, event);
  if (QMainWindow* window = mainWindow())
  {
    window->statusBar()->showMessage(tr("Running: press the cross to stop"));
  }
  event->ignore();
  return true;
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqAbortButtonBehavior.h"

#include <pqApplicationCore.h>
#include <pqProgressManager.h>

#include <QAbstractButton>
#include <QEvent>
#include <QWidget>
#include <QWindow>

namespace
{
pqProgressManager* progressManager()
{
  pqApplicationCore* core = pqApplicationCore::instance();
  return core ? core->getProgressManager() : nullptr;
}
}

//------------------------------------------------------------------------------
pqAbortButtonBehavior::pqAbortButtonBehavior() = default;
pqAbortButtonBehavior::~pqAbortButtonBehavior() = default;

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::startup()
{
  if (pqProgressManager* manager = progressManager())
  {
    this->connect(manager, SIGNAL(progressStartEvent()), SLOT(findButton()));
    this->findButton();
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::shutdown()
{
  if (pqProgressManager* manager = progressManager())
  {
    manager->disconnect(this);
  }
  if (this->Button)
  {
    this->Button->removeEventFilter(this);
    this->letThrough(false);
    this->Button = nullptr;
  }
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::findButton()
{
  if (this->Button)
  {
    return;
  }
  for (const QPointer<QObject>& object : progressManager()->nonBlockableObjects())
  {
    if (auto* button = qobject_cast<QAbstractButton*>(object.data()))
    {
      this->Button = button;
      button->installEventFilter(this);
      this->letThrough(button->underMouse());
      return;
    }
  }
}

//------------------------------------------------------------------------------
bool pqAbortButtonBehavior::eventFilter(QObject* object, QEvent* event)
{
  if (object == this->Button &&
    (event->type() == QEvent::Enter || event->type() == QEvent::Leave))
  {
    this->letThrough(event->type() == QEvent::Enter);
  }
  return this->QObject::eventFilter(object, event);
}

//------------------------------------------------------------------------------
void pqAbortButtonBehavior::letThrough(bool yes)
{
  pqProgressManager* manager = progressManager();
  QWindow* window = this->Button->window()->windowHandle();
  if (!manager || !window)
  {
    return;
  }
  manager->removeNonBlockableObject(window);
  if (yes)
  {
    manager->addNonBlockableObject(window);
  }
}

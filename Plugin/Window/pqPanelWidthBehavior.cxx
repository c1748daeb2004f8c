// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqPanelWidthBehavior.h"

#include "SurfaceSources.h"

#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqPropertiesPanel.h>

#include <QApplication>
#include <QDockWidget>
#include <QMainWindow>
#include <QPointer>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>

namespace
{
/** Milliseconds in which ParaView has all in the panel. */
constexpr int Delay = 300;

QDockWidget* dockOf(QWidget* widget)
{
  while (widget && !qobject_cast<QDockWidget*>(widget))
  {
    widget = widget->parentWidget();
  }
  return qobject_cast<QDockWidget*>(widget);
}
}

//------------------------------------------------------------------------------
pqPanelWidthBehavior::pqPanelWidthBehavior() = default;
pqPanelWidthBehavior::~pqPanelWidthBehavior() = default;

//------------------------------------------------------------------------------
void pqPanelWidthBehavior::startup()
{
  QTimer::singleShot(0, this, SLOT(watchPanels()));
}

void pqPanelWidthBehavior::shutdown() {}

//------------------------------------------------------------------------------
void pqPanelWidthBehavior::watchPanels()
{
  for (pqPropertiesPanel* panel : volumic::PropertiesPanels())
  {
    if (auto* area = panel->findChild<QScrollArea*>("scrollArea"))
    {
      this->connect(area->horizontalScrollBar(), &QScrollBar::rangeChanged, this,
        [this, shown = QPointer<QScrollArea>(area)]
        {
          QTimer::singleShot(Delay, this,
            [this, shown]
            {
              if (shown)
              {
                this->widen(shown);
              }
            });
        });
    }
  }
}

//------------------------------------------------------------------------------
void pqPanelWidthBehavior::widen(QScrollArea* area)
{
  pqPipelineSource* shown = pqActiveObjects::instance().activeSource();
  QDockWidget* dock = dockOf(area);
  auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  // A hand at the mouse may just be giving it another width.
  if (!shown || !volumic::GivesSurfaces(shown) || !dock || !window || dock->isFloating() ||
    dock->width() < this->Given || QApplication::mouseButtons() != Qt::NoButton)
  {
    return;
  }
  const int wanted = dock->width() + area->horizontalScrollBar()->maximum();
  // Most of the window is for the view: a panel that would take a third of it stays as it is.
  if (wanted > dock->width() && 3 * wanted < window->width())
  {
    window->resizeDocks({ dock }, { wanted }, Qt::Horizontal);
    this->Given = wanted;
  }
}

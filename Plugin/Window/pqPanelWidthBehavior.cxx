// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqPanelWidthBehavior.h"

#include "SurfaceSources.h"

#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqPropertiesPanel.h>

#include <QDockWidget>
#include <QMainWindow>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>

namespace
{
/** ParaView has the display in the panel soon after Apply, in milliseconds. */
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
  // Of a plugin that is loaded at the start the window has no panels yet.
  QTimer::singleShot(0, this, SLOT(watchPanels()));
}

void pqPanelWidthBehavior::shutdown() {}

//------------------------------------------------------------------------------
void pqPanelWidthBehavior::watchPanels()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  for (auto* panel : window ? window->findChildren<pqPropertiesPanel*>()
                            : QList<pqPropertiesPanel*>())
  {
    this->connect(panel, qOverload<>(&pqPropertiesPanel::applied), this,
      [this, panel] { QTimer::singleShot(Delay, panel, [this, panel] { this->widen(panel); }); });
  }
}

//------------------------------------------------------------------------------
void pqPanelWidthBehavior::widen(pqPropertiesPanel* panel)
{
  pqPipelineSource* shown = pqActiveObjects::instance().activeSource();
  auto* area = panel->findChild<QScrollArea*>("scrollArea");
  QDockWidget* dock = dockOf(panel);
  auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  if (this->HasWidened || !shown || !volumic::GivesSurfaces(shown) || !area || !area->widget() ||
    !dock || !window || dock->isFloating())
  {
    return;
  }
  const int missing = area->horizontalScrollBar()->maximum();
  // Of a view that is no wider than its panel nobody has anything.
  if (missing > 0 && 3 * (dock->width() + missing) < window->width())
  {
    window->resizeDocks({ dock }, { dock->width() + missing }, Qt::Horizontal);
    this->HasWidened = true;
  }
}

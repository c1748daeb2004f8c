// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqPanelWidthBehavior_h
#define pqPanelWidthBehavior_h

#include <QObject>

class QScrollArea;

/**
 * When a surface of ours has been applied its display joins the properties in the panel, and needs
 * more width than ParaView's dock has in a small window, as advanced properties do: the dock is made
 * as wide, where that is less than a third of the window. Who makes it narrower afterwards is left
 * alone.
 */
class pqPanelWidthBehavior : public QObject
{
  Q_OBJECT

public:
  pqPanelWidthBehavior();
  ~pqPanelWidthBehavior() override;

  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void watchPanels();

private:
  void widen(QScrollArea* area);

  int Given = 0; ///< width

  Q_DISABLE_COPY(pqPanelWidthBehavior)
};

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqLabelLegendBehavior_h
#define pqLabelLegendBehavior_h

#include <QList>
#include <QObject>
#include <QPointer>

class pqDataRepresentation;
class pqRepresentation;

/**
 * At Apply ParaView shows the legend of each new display that is coloured by an array. What is made of
 * surfaces of labels, such as a Clip, has none where the surfaces have none.
 */
class pqLabelLegendBehavior : public QObject
{
  Q_OBJECT

public:
  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void watchPanels();
  /** Remember a display whose input has no legend. */
  void add(pqRepresentation* display);
  void hideLegends();

private:
  QList<QPointer<pqDataRepresentation>> WithoutLegend; ///< since the last Apply
};

#endif

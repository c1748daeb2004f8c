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
 * Hides the legend of a filter downstream of surfaces, such as Clip, if the surfaces have no
 * legend. At Apply ParaView shows the legend of each new display that is coloured by an array.
 */
class pqLabelLegendBehavior : public QObject
{
  Q_OBJECT

public:
  /** ParaView calls these after loading the plugin, and at exit. */
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

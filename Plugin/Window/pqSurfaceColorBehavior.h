// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqSurfaceColorBehavior_h
#define pqSurfaceColorBehavior_h

#include <QObject>

class pqRepresentation;

/**
 * What is made of a surface, such as a Clip, a Threshold or a block of the levels, gets the colour
 * that the surface has in the active view, when it is shown first.
 */
class pqSurfaceColorBehavior : public QObject
{
  Q_OBJECT

public:
  pqSurfaceColorBehavior();
  ~pqSurfaceColorBehavior() override;

  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void giveColor(pqRepresentation* display);

private:
  Q_DISABLE_COPY(pqSurfaceColorBehavior)
};

#endif

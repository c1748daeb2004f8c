// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqUnfinishedBehavior_h
#define pqUnfinishedBehavior_h

#include <QList>
#include <QObject>
#include <QPointer>

#include <pqPipelineSource.h>

/**
 * Keeps Apply active after a stopped run, and lets Apply resume the run. Not with Auto Apply, which
 * would resume at once.
 */
class pqUnfinishedBehavior : public QObject
{
  Q_OBJECT

public:
  pqUnfinishedBehavior();
  ~pqUnfinishedBehavior() override;

  /** ParaView calls these after loading the plugin, and at exit. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void watchPanels();
  void onDataUpdated(pqPipelineSource* source);
  void resume(pqProxy* source);

private:
  QList<QPointer<pqPipelineSource>> Unfinished;

  Q_DISABLE_COPY(pqUnfinishedBehavior)
};

#endif

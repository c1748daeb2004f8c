// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqUnfinishedBehavior_h
#define pqUnfinishedBehavior_h

#include <QList>
#include <QObject>
#include <QPointer>

#include <pqPipelineSource.h>

/**
 * After a run that was stopped Apply stays active, and goes on, though no property has changed. Not
 * with Auto Apply, with which nothing could stop it.
 */
class pqUnfinishedBehavior : public QObject
{
  Q_OBJECT

public:
  pqUnfinishedBehavior();
  ~pqUnfinishedBehavior() override;

  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void watchPanels();
  void look(pqPipelineSource* source);
  void goOn(pqProxy* source);

private:
  QList<QPointer<pqPipelineSource>> Unfinished;

  Q_DISABLE_COPY(pqUnfinishedBehavior)
};

#endif

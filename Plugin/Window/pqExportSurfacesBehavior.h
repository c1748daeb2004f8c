// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqExportSurfacesBehavior_h
#define pqExportSurfacesBehavior_h

#include <QObject>
#include <QPointer>

class QAction;

/**
 * The entry Export Surfaces... below Save Data... in the menu File: a file for each label, level or
 * component of what is selected, if it comes from a filter of Volumic and has cells; without blocks that are
 * hidden in the active view. vtkVolumicSurfacesWriter writes them.
 */
class pqExportSurfacesBehavior : public QObject
{
  Q_OBJECT

public:
  pqExportSurfacesBehavior();
  ~pqExportSurfacesBehavior() override;

  /** Called by ParaView when it has loaded the plugin, and when it ends. */
  void startup();
  void shutdown();

private Q_SLOTS:
  void addAction();
  void enable();
  void askAndExport();

private:
  QPointer<QAction> Action;

  Q_DISABLE_COPY(pqExportSurfacesBehavior)
};

#endif

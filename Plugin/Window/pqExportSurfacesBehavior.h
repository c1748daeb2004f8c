// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqExportSurfacesBehavior_h
#define pqExportSurfacesBehavior_h

#include <QObject>
#include <QPointer>

class QAction;

/**
 * The entry Export Surfaces... below Save Data... in the menu File. It writes a file for each label,
 * level or component of the selected output of a filter of Volumic. Blocks that are hidden in the
 * active view are left out. The class SurfacesWriter of volumic_paraview.py writes the files.
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

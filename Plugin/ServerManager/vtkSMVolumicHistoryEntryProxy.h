// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMVolumicHistoryEntryProxy
 * @brief   opens the chart of a history as soon as it is to be shown in a 3D view
 *
 * Whoever makes it visible (a click on the eye in the pipeline browser, Show() of a script) gets a
 * chart beside the active view, or, where there is one of that history already, that chart again.
 * The entry itself is never visible for long: the next click does the same.
 */
#ifndef vtkSMVolumicHistoryEntryProxy_h
#define vtkSMVolumicHistoryEntryProxy_h

#include "vtkSMRepresentationProxy.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class vtkSMSourceProxy;
class vtkSMViewProxy;

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkSMVolumicHistoryEntryProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMVolumicHistoryEntryProxy* New();
  vtkTypeMacro(vtkSMVolumicHistoryEntryProxy, vtkSMRepresentationProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void UpdateVTKObjects() override;

protected:
  vtkSMVolumicHistoryEntryProxy();
  ~vtkSMVolumicHistoryEntryProxy() override;

private:
  vtkSMVolumicHistoryEntryProxy(const vtkSMVolumicHistoryEntryProxy&) = delete;
  void operator=(const vtkSMVolumicHistoryEntryProxy&) = delete;

  void ShowChart(vtkSMSourceProxy* source, unsigned int port);
  /** A chart that holds that output, shown or hidden; nullptr if there is none. */
  vtkSMViewProxy* FindChart(vtkSMSourceProxy* source, unsigned int port);
  vtkSMViewProxy* OpenChart();

  bool IsShowing = false;
};

#endif

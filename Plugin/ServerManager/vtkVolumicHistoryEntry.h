// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumicHistoryEntry
 * @brief   stands for a history in a 3D view, where nothing of it is drawn
 *
 * With it, the pipeline browser has an eye for the history while a 3D view is active; see
 * vtkSMVolumicHistoryEntryProxy for what the eye does.
 */
#ifndef vtkVolumicHistoryEntry_h
#define vtkVolumicHistoryEntry_h

#include "vtkPVDataRepresentation.h"
#include "vtkServerManagerVolumicModule.h" // For export macro

class VTKSERVERMANAGERVOLUMIC_EXPORT vtkVolumicHistoryEntry : public vtkPVDataRepresentation
{
public:
  static vtkVolumicHistoryEntry* New();
  vtkTypeMacro(vtkVolumicHistoryEntry, vtkPVDataRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkVolumicHistoryEntry();
  ~vtkVolumicHistoryEntry() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkVolumicHistoryEntry(const vtkVolumicHistoryEntry&) = delete;
  void operator=(const vtkVolumicHistoryEntry&) = delete;
};

#endif

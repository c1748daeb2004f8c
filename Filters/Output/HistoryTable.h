// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHistoryTable_h
#define volumicHistoryTable_h

#include "Core/Evolution/EvolutionHistory.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkTable;

namespace volumic
{
/**
 * A row per iteration on the levels down to `last`, the columns that vtkDeformableSurface documents.
 * @param unit of the workspace, world units
 */
vtkSmartPointer<vtkTable> MakeHistoryTable(
  const std::vector<HistoryRow>& rows, int last, double unit);
}

#endif

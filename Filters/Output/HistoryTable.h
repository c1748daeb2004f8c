// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicHistoryTable_h
#define volumicHistoryTable_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/Workspace.h"

#include <vtkSmartPointer.h>

#include <vector>

class vtkTable;

namespace volumic
{
/**
 * A row per iteration, the columns that vtkDeformableSurface documents; those of the phases too,
 * if asked for.
 */
vtkSmartPointer<vtkTable> MakeHistory(
  const std::vector<HistoryRow>& rows, const Workspace& space, bool withPhases);
}

#endif

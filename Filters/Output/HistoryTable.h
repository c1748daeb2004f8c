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
 * Return the output History of vtkDeformableSurface, a row per iteration down to level `last`.
 * @param unit length 1 of the computational space in world units
 */
vtkSmartPointer<vtkTable> MakeHistoryTable(std::vector<HistoryRow> rows, int last, double unit);
}

#endif

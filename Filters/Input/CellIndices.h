// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCellIndices_h
#define volumicCellIndices_h

#include <string>

class vtkPolyData;

namespace volumic
{
/**
 * What is wrong with the cells of data that come from elsewhere, as words behind a name: their
 * points are others than those that are there, at which VTK's filters end the program. Empty:
 * nothing.
 */
std::string FaultOfCells(vtkPolyData* data);
}

#endif

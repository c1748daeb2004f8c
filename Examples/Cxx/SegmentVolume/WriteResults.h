// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef WriteResults_h
#define WriteResults_h

#include <string>

class vtkMultiBlockDataSet;
class vtkPolyData;
class vtkTable;

namespace tool
{
/// @throws Failure if no writer has this suffix: to call before the work begins.
void CheckSurfaceName(const std::string& name);

/**
 * Write a surface in the format of the suffix. Arrays and field data go along where the format has
 * a place for them (.vtp, .vtk). `remark`, a line, is put into the head of the file where the
 * format has one (.stl, .ply). @throws Failure if it cannot be written.
 */
void WriteSurface(vtkPolyData* surface, const std::string& name, const std::string& remark);

/// Write the blocks that are not empty: to one .vtm, or each to DIR/PREFIX-NUMBER.vtp,
/// where `numbers` tells a surface's number (none: that of the block).
/// @throws Failure if they cannot be written.
void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  int (*numbers)(vtkPolyData*) = nullptr);

/// Write a .csv with a line of column names. @throws Failure if it cannot be written.
void WriteTable(vtkTable* table, const std::string& name);

/// @throws Failure if the folder of the file is not there.
void CheckFolderOf(const std::string& name);
}

#endif

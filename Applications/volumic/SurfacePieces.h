// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolSurfacePieces_h
#define volumicToolSurfacePieces_h

#include "ProgressLine.h"

#include <string>

class vtkPolyData;

namespace tool
{
/**
 * Write a surface of triangles as .pvtp, which names its pieces, STEM/STEM_0.vtp, ... beside it, for
 * programs that read some of them only, or each process its own. A piece has `size` triangles that
 * follow each other in the surface, the last one what is left, and their points. Points that
 * triangles of several pieces share are in each of these; the point array GlobalIds tells which
 * point of the surface each one is. Of the pieces one is in memory at a time. Field data are in each.
 * @throws Failure without the file's name.
 */
void WritePieces(vtkPolyData* surface, const std::string& path, int size, ProgressLine& line);

// The parts of that, for surfaces of which each rank has some triangles, and GlobalIds of its own.

/** How many pieces there will be. */
int NumberOfPieces(vtkPolyData* surface, int size);

/**
 * Write the pieces into the folder beside `path`, which is there.
 * @param first the number of the first of them
 * @return what the .pvtp tells of their arrays; empty: there is no piece.
 */
std::string WritePieceFiles(
  vtkPolyData* surface, const std::string& path, int size, int first, ProgressLine& line);

/** Write the .pvtp itself. @param arrays as WritePieceFiles has told of any piece */
void WritePieceList(const std::string& path, const std::string& arrays, int pieces);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicWriteResults_h
#define volumicWriteResults_h

#include "Messages.h"

#include <string>
#include <vector>

class vtkImageData;
class vtkMultiBlockDataSet;
class vtkPolyData;
class vtkTable;

namespace tool
{
struct SceneObject;
class SolidMaker;

// All write beside the file, which takes its place when it is whole (see OutputFiles.h), and throw
// a Failure that names the file if that cannot be. What is large shows its progress.

/** @throws UsageError if no writer has this suffix: to call before the work begins. */
void CheckSurfaceName(const std::string& name);

/** Whether a surface of this name has files in a folder beside it. */
bool HasPieces(const std::string& name);

/** Whether a file of this name holds several surfaces with their names and colours. */
bool IsScene(const std::string& name);

/** Whether a file of this name is for meshers of solids: of labels it needs shared interfaces. */
bool IsOfSolids(const std::string& name);

/** How a surface is written. */
struct SurfaceWriting
{
  /**
   * What the head of the file says beside our name and the space, where the format has a place for
   * that (.stl, .ply, .obj, .vtk, .msh, .smesh).
   */
  std::string Remark;
  int PieceSize = 0; ///< triangles of a piece, where there are pieces
  ProgressStyle Style = ProgressStyle::None;
  SolidMaker* Solids = nullptr; ///< of files of tetrahedra; null: one of its own
};

/**
 * Write a surface in the format of the suffix. Arrays and field data go along where the format has
 * a place for them (.vtp, .pvtp, .vtk), and colours of labels (.ply, .glb). Interfaces of labels
 * may be what is written, as .vtp, .vtk and where IsOfSolids().
 */
void WriteSurface(vtkPolyData* surface, const std::string& name, const SurfaceWriting& writing);

/** @throws UsageError if the name of a volume to write does not end in .vti. */
void CheckVolumeName(const std::string& name);

/** Write a volume with all its arrays and field data as .vti. */
void WriteVolume(vtkImageData* volume, const std::string& name, ProgressStyle style);

/** Write the surfaces that are not empty to one file of which IsScene() is true. */
void WriteScene(
  const std::vector<SceneObject>& objects, const std::string& name, ProgressStyle style);

/** Write the blocks that are not empty to one .vtm, with their files in a folder beside it. */
void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name, ProgressStyle style);

/**
 * Write each block that is not empty to FOLDER/PREFIX-NUMBER.vtp, where `numbers` tells a
 * surface's number (none: that of the block). The folder is made.
 */
void WriteFolder(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  ProgressStyle style, int (*numbers)(vtkPolyData*) = nullptr);

/** Write a .csv with a line of column names. */
void WriteTable(vtkTable* table, const std::string& name);

/** Write a text; "-" is the standard output. */
void WriteText(const std::string& text, const std::string& name);
}

#endif

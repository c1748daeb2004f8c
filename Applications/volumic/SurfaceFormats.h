// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFormats_h
#define volumicSurfaceFormats_h

#include "Messages.h"

#include <string>

class vtkMultiBlockDataSet;
class vtkPolyData;

namespace tool
{
class SolidMaker;

/** A surface, and all that is told to a writer of it. */
struct SurfaceFile
{
  vtkPolyData* Surface;
  std::string Path;
  std::string Remark;
  int PieceSize;
  ProgressLine& Line;
  SolidMaker* Solids = nullptr; ///< of formats that hold tetrahedra
};

/** Writes a file of a format, and throws a Failure without its name. */
using SurfaceWriter = void (*)(const SurfaceFile&);

/** By the suffix; null: there is none. */
SurfaceWriter FindSurfaceWriter(const std::string& name);

// ---- Pieces -------------------------------------------------------------------------------------

/**
 * Write a surface of triangles as .pvtp, which names its pieces, STEM/STEM_0.vtp, ... beside it,
 * for programs that read some of them only, or each process its own. A piece has PieceSize
 * triangles that follow each other in the surface, the last one what is left, and their points.
 * Points that triangles of several pieces share are in each of these; the point array GlobalIds
 * tells which point of the surface each one is. Of the pieces one is in memory at a time. Field
 * data are in each.
 */
void WritePieces(const SurfaceFile& file);

/**
 * Write surfaces as .vtm, which names their files, STEM/STEM_0.vtp, ... beside it. Those that are
 * null have none.
 */
void WriteVtm(vtkMultiBlockDataSet* blocks, const std::string& path, ProgressLine& line);

// The parts of .pvtp, for surfaces of which each rank has some triangles, and GlobalIds of its own.

/** How many pieces there will be. */
int NumberOfPieces(vtkPolyData* surface, int size);

/**
 * Write the pieces into the folder beside the path, which is there.
 * @param first the number of the first of them
 * @return what the .pvtp tells of their arrays; empty: there is no piece.
 */
std::string WritePieceFiles(const SurfaceFile& file, int first);

/** Write the .pvtp itself. @param arrays as WritePieceFiles has told of any piece */
void WritePieceList(const std::string& path, const std::string& arrays, int pieces);

// ---- Solids -------------------------------------------------------------------------------------

// What meshers of solids fill with tetrahedra: a closed surface, or the output `Interfaces` of
// vtkLabelsToSurfaces. Triangles between the same two labels, or a label and the outside, are
// marked with the same number, 1 and more, which is named `liver_to_kidney`, `liver_to_outside`.

/**
 * MSH 4.1 of gmsh, as text: a surface for each pair of regions that touch, a volume for each
 * region, without elements, that tells which surfaces bound it; physical surfaces and volumes,
 * these with the labels as numbers where these are positive, named as the labels.
 */
void WriteMsh(const SurfaceFile& file);

/** A name as gmsh takes it: it reads lines of 255 bytes, with names in quotes. */
std::string GmshWord(const std::string& name);

/** TetGen's .smesh: a point in each region, with its label, and in each cavity. */
void WriteSmesh(const SurfaceFile& file);

/** The same as .poly. */
void WritePoly(const SurfaceFile& file);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSolverFiles_h
#define volumicSolverFiles_h

#include "ProgressLine.h"

#include <string>

class vtkPolyData;

namespace tool
{
// What meshers of solids fill with tetrahedra: a closed surface, or the output `Interfaces` of
// vtkLabelsToSurfaces. Triangles between the same two labels, or a label and the outside, are marked
// with the same number, 1 and more, which is named `liver_to_kidney`, `liver_to_outside`. All throw
// a Failure without the file's name.

/**
 * MSH 4.1 of gmsh, as text: a surface for each pair of regions that touch, a volume for each region,
 * without elements, that tells which surfaces bound it; physical surfaces and volumes, these with the
 * labels as numbers where these are positive, named as the labels.
 */
void WriteMsh(vtkPolyData* surface, const std::string& path, const std::string& remark,
  ProgressLine& line);

/** TetGen's .smesh: a point in each region, with its label, and in each cavity. */
void WriteSmesh(vtkPolyData* surface, const std::string& path, const std::string& remark,
  ProgressLine& line);

/** The same as .poly. */
void WritePoly(vtkPolyData* surface, const std::string& path, const std::string& remark,
  ProgressLine& line);
}

#endif

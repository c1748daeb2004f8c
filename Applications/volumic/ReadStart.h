// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReadStart_h
#define volumicReadStart_h

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace tool
{
/**
 * The points of a file as vertices: of a mesh (as ReadSurface), or of the lines "x y z", separated
 * by blanks or commas, of a .txt, .csv or .xyz file; '#' begins a comment, and a first line
 * of names alone ("x,y,z") is a heading. World coordinates. @throws Failure if it cannot be read
 * or has no points.
 */
vtkSmartPointer<vtkPolyData> ReadSeeds(const std::string& name);

/**
 * Points that are known to belong to the object, as ReadSeeds, but a fourth and fifth number of a
 * line are the point arrays `Weight` and `Radius` of vtkDeformableSurface (1 and 0 where a line
 * lacks them), and a mesh keeps its arrays of these names.
 */
vtkSmartPointer<vtkPolyData> ReadAttractingPoints(const std::string& name);

/**
 * The polygons of a .vtp, .vtk, .stl, .ply or .obj. Equal points are made one (an STL file repeats
 * them). @throws Failure if it cannot be read or has no polygons.
 */
vtkSmartPointer<vtkPolyData> ReadSurface(const std::string& name);
}

#endif

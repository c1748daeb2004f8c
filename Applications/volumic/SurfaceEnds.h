// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEnds_h
#define volumicSurfaceEnds_h

#include <vtkSmartPointer.h>

class vtkImageData;
class vtkPolyData;

namespace tool
{
/** What becomes of a surface where its object leaves the image, or the region of it. */
enum class Ends
{
  Closed, ///< nothing: a cap closes it
  Marked, ///< cell array `Cap`: 0, or the number of the cap that a triangle is of, from 1
  Open    ///< it ends a voxel within the outermost voxels' centres, in closed curves
};

/** @return the surface, or one made of it. Its field data stay those of the closed one. */
vtkSmartPointer<vtkPolyData> WithEnds(vtkPolyData* surface, vtkImageData* image, Ends ends);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceEnds_h
#define volumicSurfaceEnds_h

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkImageData;
class vtkPolyData;

namespace tool
{
/** What becomes of a surface where its object leaves the image, or the region of it. */
enum class Ends
{
  Closed, ///< nothing: a cap closes it
  Marked, ///< flat caps close it, a voxel within the outermost voxels' centres, or a bit further
  Open    ///< it ends there in closed curves
};

/**
 * Marked, it has the cell arrays `Cap`, 0 or the number of the cap, from 1, that a triangle is of,
 * and `BoxFace`, at which side of the image the cap is, as vtkLabelsToSurfaces has it.
 * @return the surface, or one made of it: where all of it lies about the outermost voxels it stays
 * as it is, and where no flat caps close it, too, with a warning. Field data stay those of the
 * closed one.
 */
vtkSmartPointer<vtkPolyData> WithEnds(
  vtkPolyData* surface, vtkImageData* image, Ends ends, std::vector<std::string>& warnings);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicCellVoxels_h
#define volumicCellVoxels_h

#include <vtkSmartPointer.h>

class vtkImageData;
class vtkInformation;

namespace volumic
{
/** An image whose voxels are points, and which array they are in. */
struct PointVoxels
{
  vtkSmartPointer<vtkImageData> Image;
  vtkSmartPointer<vtkInformation> Selection; ///< as GetInputArrayInformation()
};

/**
 * The image as it is where its voxels are points. Where a cell array is chosen, or none and only
 * cells have active scalars, an image whose points are the centres of the cells: it shares the
 * array, so that no value is blurred, as it would be by the way to the corners. Of no image it
 * makes none.
 */
PointVoxels TakeCellsAsPoints(vtkImageData* image, vtkInformation* selection);
}

#endif

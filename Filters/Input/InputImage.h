// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicInputImage_h
#define volumicInputImage_h

#include <vtkSmartPointer.h>

class vtkDataObject;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;

namespace volumic
{
/**
 * Return the data of an input port, or null if there are none.
 * @throws InvalidArgument if they are only a part of the requested image, as from a source that is
 *   distributed over processes
 */
vtkDataObject* WholeInput(vtkInformationVector* port);

/**
 * Return the image of an input: the input itself, the only image in a composite dataset, or block 0
 * of a pyramid.
 * @throws InvalidArgument if there is no image, or if there are several
 */
vtkImageData* ImageOf(vtkDataObject* input);

/** The end of messages about blocks that are not levels. */
inline constexpr const char* LevelsAdvice =
  " Connect the output of Image Pyramid, or the image itself.";

/**
 * Check that the size and position of an image are those of level h of a pyramid.
 * @param below level h - 1
 * @throws InvalidArgument if they are not
 */
void CheckGeometry(vtkImageData* level0, vtkImageData* below, vtkImageData* image, unsigned int h);

/** An image whose voxels are points, and the selection of their array. */
struct PointVoxels
{
  vtkSmartPointer<vtkImageData> Image;
  vtkSmartPointer<vtkInformation> Selection; ///< as GetInputArrayInformation()
};

/**
 * Return the image itself if its voxels are points. If a cell array is selected, or only cells have
 * active scalars, return an image whose points are the centers of the cells. It shares the array,
 * so values are not interpolated.
 */
PointVoxels ConvertCellsToPoints(vtkImageData* image, vtkInformation* selection);
}

#endif

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
 * Return the data at an input port; null if there are none.
 * @throws std::invalid_argument if they are a part of the image that was requested: a source that
 * is distributed over processes cannot give one process the whole.
 */
vtkDataObject* WholeInput(vtkInformationVector* port);

/**
 * The image that the input of a filter means: itself; the only image in a composite dataset; block
 * 0 of a pyramid.
 * @throws std::invalid_argument naming the type and the way out if there is none, or if there are
 *         several.
 */
vtkImageData* ImageOf(vtkDataObject* input);

/** What messages about blocks that are no levels end with. */
inline constexpr const char* LevelsWayOut =
  " Give the output of Image Pyramid, or the image itself.";

/**
 * Looks whether an image is level h of the pyramid of level 0, by its size and place.
 * @param below level h - 1
 * @throws std::invalid_argument naming the block and the way out if it is not.
 */
void CheckGeometry(vtkImageData* level0, vtkImageData* below, vtkImageData* image, unsigned int h);

/** An image whose voxels are points, and which array they are in. */
struct PointVoxels
{
  vtkSmartPointer<vtkImageData> Image;
  vtkSmartPointer<vtkInformation> Selection; ///< as GetInputArrayInformation()
};

/**
 * The image as it is where its voxels are points. Where a cell array is chosen, or none and only
 * cells have active scalars, an image whose points are the centres of the cells: it shares the
 * array, so that no value is blurred, as it would be by the way to the corners.
 */
PointVoxels TakeCellsAsPoints(vtkImageData* image, vtkInformation* selection);
}

#endif

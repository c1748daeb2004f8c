// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BuildPyramid_h
#define BuildPyramid_h

#include <vtkSmartPointer.h>

class vtkImageData;
class vtkImagePyramid;
class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
/**
 * The levels of an image, by a pyramid with the settings wanted.
 * @param selection of the voxels, as GetInputArrayInformation()
 * @throws std::invalid_argument with the pyramid's message; std::runtime_error if it is not the
 *         user's fault (memory).
 */
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImagePyramid* pyramid, vtkImageData* image, vtkInformation* selection);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BuildPyramid_h
#define BuildPyramid_h

#include "Core/Monitor.h"

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
 * @param goOn      asked as the pyramid's progress goes
 * @return null if that said stop.
 * @throws std::invalid_argument with the pyramid's message.
 */
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImagePyramid* pyramid, vtkImageData* image, vtkInformation* selection, const Checkpoint& goOn);
}

#endif

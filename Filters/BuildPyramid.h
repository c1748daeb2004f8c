// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBuildPyramid_h
#define volumicBuildPyramid_h

#include "Core/Common/Communicator.h"
#include "Core/Common/Monitor.h"
#include "Core/Evolution/EdgeLengthPlan.h"

#include <vtkSmartPointer.h>

class vtkImageData;
class vtkImagePyramid;
class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
/**
 * What gives edges of a mean length (world units) at the finest level; sets the factor of the
 * pyramid, which is not made yet, to the plan's.
 * @throws std::invalid_argument naming the lengths that are possible.
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, vtkImagePyramid* pyramid);

/**
 * The levels of an image, by a pyramid with the settings wanted. By all ranks together.
 * @param image     this rank's piece; null: none
 * @param selection of the voxels, as GetInputArrayInformation()
 * @param goOn      asked as the pyramid's progress goes
 * @return null if that said stop.
 * @throws std::invalid_argument with the pyramid's message; std::runtime_error if it is not the
 *         user's fault (memory).
 */
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(Communicator& ranks, vtkImagePyramid* pyramid,
  vtkImageData* image, vtkInformation* selection, const Checkpoint& goOn);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBuildPyramid_h
#define volumicBuildPyramid_h

#include "Core/Evolution/EdgeLengthPlan.h"
#include "Pyramid/PyramidBlocks.h"

#include <vtkSmartPointer.h>

class vtkImageData;
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
  double edgeLength, double samplingRatio, vtkImageData* image, PyramidOptions& pyramid);

/**
 * The levels of an image, as vtkImagePyramid has them.
 * @param selection of the voxels, as GetInputArrayInformation()
 * @param component of them, as SelectComponent() takes it
 * @return null if the request's Progress said stop.
 * @throws std::invalid_argument naming input port 0; others as they are.
 */
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(vtkImageData* image,
  vtkInformation* selection, int component, const PyramidRequest& request);

/** As many levels as the blocks are, by the factor that they tell. */
PyramidOptions LevelsAs(vtkMultiBlockDataSet* blocks);
}

#endif

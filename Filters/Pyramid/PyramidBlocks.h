// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidBlocks_h
#define volumicPyramidBlocks_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
/** The share of the whole work that is done, in [0, 1], and the text for it; false asks to stop. */
using PyramidProgress = std::function<bool(double share, const std::string& text)>;

/** What vtkImagePyramid is asked for. */
struct PyramidRequest
{
  PyramidOptions Levels;
  ValueRange Range; ///< Levels, also level 0, are made of voxels folded by it (FoldVoxels).
  bool NaNIsBackground = true;
  int NumberOfThreads = 0;
  PyramidProgress Progress;
};

/** The blocks of vtkImagePyramid's output, with its field data. */
struct PyramidBlocks
{
  vtkSmartPointer<vtkMultiBlockDataSet> Blocks;
  std::string AboutNaNs; ///< what to warn of; empty: nothing
};

/**
 * @param image  level 0
 * @param voxels of it, one component
 * @throws as vtkImagePyramid reports.
 */
PyramidBlocks MakePyramidBlocks(
  vtkImageData* image, vtkDataArray* voxels, const PyramidRequest& request);

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
vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImageData* image, vtkInformation* selection, int component, const PyramidRequest& request);

/** As many levels as the blocks are, by the factor that they tell. */
PyramidOptions LevelsAs(vtkMultiBlockDataSet* blocks);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidBlocks_h
#define volumicPyramidBlocks_h

#include "Core/Image/PyramidGeometry.h"
#include "Input/ValueRange.h"
#include "Pyramid/LevelVoxels.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkDataArray;
class vtkImageData;
class vtkMultiBlockDataSet;

namespace volumic
{
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

/** Those where the work was stopped before there was an image. */
PyramidBlocks StoppedPyramidBlocks();
}

#endif

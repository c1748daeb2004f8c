// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImageLevels_h
#define volumicImageLevels_h

#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Image/PyramidGeometry.h"
#include "Host/RunObserver.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <vector>

class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
struct ImageLevel
{
  vtkSmartPointer<vtkImageData> Image; ///< geometry and ghost array (blanked voxels)
  vtkSmartPointer<vtkDataArray> Voxels;
  double Unit = 0.0; ///< U_h, world units
};

/** The levels of an image. Level 0 is the image itself. */
struct ImageLevels
{
  std::vector<ImageLevel> Levels;
  double FactorBelow = 1.7320508075688772; ///< U_0 over the unit of level -1
  bool IsComplete = true;                  ///< false: stopped before the last level
  std::int64_t NaNs = 0;                   ///< number of NaN voxels of level 0
  std::string NaNWarning;                  ///< warning about them; empty if already reported

  /** Return the options for the same number of levels and the same reduction factor. */
  PyramidOptions Options() const;
};

struct LevelsOptions
{
  PyramidOptions Pyramid;
  ValueRange Range; ///< range of FoldVoxels() for level 0
  bool NaNIsBackground = true;
  unsigned NumberOfThreads = 0; ///< 0: all
};

/**
 * Compute the levels of an image, as vtkImagePyramid does. If `progress` returns false, return the
 * finished levels.
 * @param image    level 0; its arrays are shared
 * @param voxels   array of the image with one component
 * @throws InvalidArgument for invalid options or voxels
 */
ImageLevels MakeImageLevels(vtkImageData* image, vtkDataArray* voxels, const LevelsOptions& options,
  const Progress& progress);

/**
 * Return the blocks of an output of vtkImagePyramid as levels.
 * @param selection the array of the voxels (GetInputArrayInformation)
 * @throws InvalidArgument naming the block that is not an image, lacks the array, or does not have
 *   the size or position of a level
 */
ImageLevels LevelsOfBlocks(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, bool nanIsBackground);

/**
 * Return the levels of another array of the image. Compute them from the array of level 0, unless
 * all levels have an array of this name.
 * @throws InvalidArgument if level 0 has no such array with one component
 */
ImageLevels LevelsOfArray(const ImageLevels& levels, vtkInformation* selection, int numberOfThreads,
  const Progress& progress);

std::vector<std::string> LevelNames(int numberOfLevels, int finest = 0);

/** Return the levels as the blocks of the output of vtkImagePyramid, with its field data. */
vtkSmartPointer<vtkMultiBlockDataSet> BlocksOf(const ImageLevels& levels);

/**
 * Plan the levels for a mean edge length (world units) at the finest level. Set the reduction
 * factor of the pyramid accordingly.
 * @throws InvalidArgument naming the possible lengths
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, PyramidOptions& pyramid);
}

#endif

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
/** One level of an image. */
struct ImageLevel
{
  vtkSmartPointer<vtkImageData> Image; ///< geometry and ghost array (blanked voxels)
  vtkSmartPointer<vtkDataArray> Voxels;
  double Unit = 0.0; ///< U_h, in the unit of the spacing
};

/** The levels of an image. Level 0 is the image itself. */
struct ImageLevels
{
  std::vector<ImageLevel> Levels;
  double FactorBelow = 1.7320508075688772; ///< U_0 over the unit of level -1
  bool IsComplete = true;                  ///< false: stopped before the last level
  std::int64_t NaNs = 0;                   ///< number of NaN voxels of level 0
  std::string AboutNaNs;                   ///< warning about them; empty if reported already

  /** Return the options for the same number of levels and the same reduction factor. */
  PyramidOptions Options() const;
};

/** How to compute the levels of an image. */
struct LevelsOptions
{
  PyramidOptions Pyramid;
  ValueRange Range; ///< FoldVoxels() applies it to level 0 first.
  bool NaNIsBackground = true;
  unsigned NumberOfThreads = 0; ///< 0: all
};

/**
 * Compute the levels of an image, as vtkImagePyramid does. If `progress` returns false the levels
 * that are finished are returned.
 * @param image    level 0; its arrays are shared
 * @param voxels   array of the image with one component
 * @throws Refusal for invalid options or voxels
 */
ImageLevels MakeImageLevels(vtkImageData* image, vtkDataArray* voxels,
  const LevelsOptions& options, const Progress& progress);

/**
 * Return the blocks of an output of vtkImagePyramid as levels.
 * @param selection the array of the voxels (GetInputArrayInformation)
 * @throws Refusal naming the block that is not an image, lacks the array, or has not the size or
 *         position of a level
 */
ImageLevels LevelsOfBlocks(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, bool nanIsBackground);

/**
 * Return the levels of another array of the image. They are computed from the array of level 0,
 * unless all levels have an array of its name.
 * @throws Refusal if level 0 has no such array with one component
 */
ImageLevels LevelsOfArray(const ImageLevels& levels, vtkInformation* selection,
  int numberOfThreads, const Progress& progress);

/** Return the names of the blocks of a pyramid's levels, and of level -1 if that is the finest. */
std::vector<std::string> LevelNames(int numberOfLevels, int finest = 0);

/** Return the levels as the blocks of the output of vtkImagePyramid, with its field data. */
vtkSmartPointer<vtkMultiBlockDataSet> BlocksOf(const ImageLevels& levels);

/**
 * What gives edges of a mean length (world units) at the finest level; sets the factor of the
 * pyramid, which is not made yet, to the plan's.
 * @throws std::invalid_argument naming the lengths that are possible.
 */
EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, PyramidOptions& pyramid);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicImageLevels_h
#define volumicImageLevels_h

#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Image/PyramidGeometry.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
/** One level of an image. */
struct ImageLevel
{
  vtkSmartPointer<vtkImageData> Image; ///< its place, and which of its voxels are blanked
  vtkSmartPointer<vtkDataArray> Voxels;
  double Unit = 0.0; ///< U_h, in the unit of the spacing
};

/** The levels of an image, level 0, the image itself, first. */
struct ImageLevels
{
  std::vector<ImageLevel> Levels;
  double FactorBelow = 1.7320508075688772; ///< U_0 over the unit of level -1
  bool IsComplete = true;                  ///< Else their making was stopped.
  std::int64_t NaNs = 0;                   ///< voxels of level 0 that are NaN
  std::string AboutNaNs;                   ///< what nobody has been told of them yet

  /** As many levels as these, by the same factor. */
  PyramidOptions Options() const;
};

/** How levels are made of an image. */
struct LevelsOptions
{
  PyramidOptions Pyramid;
  ValueRange Range; ///< Levels, also level 0, are made of voxels folded by it (FoldVoxels).
  bool NaNIsBackground = true;
  int NumberOfThreads = 0;
};

/**
 * The levels as vtkImagePyramid has them. After a stop those that were finished are there.
 * @param image    level 0; its arrays are shared
 * @param voxels   of it, one component
 * @param progress told the share that is done, and what is being done; false asks to stop
 * @throws std::invalid_argument as vtkImagePyramid reports.
 */
ImageLevels MakeImageLevels(vtkImageData* image, vtkDataArray* voxels,
  const LevelsOptions& options, const std::function<bool(double, const std::string&)>& progress);

/**
 * The blocks of vtkImagePyramid's output as levels.
 * @param selection says which array holds the voxels (GetInputArrayInformation)
 * @throws std::invalid_argument naming a block that is not an image, has no such array, or whose
 *         size or place are not those of a level.
 */
ImageLevels LevelsOfBlocks(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, bool nanIsBackground);

/**
 * The levels of another array of the image: those of the levels' own arrays where all have one of
 * its name, else made of that of level 0.
 * @throws std::invalid_argument where there is no such array of one component
 */
ImageLevels LevelsOfArray(const ImageLevels& levels, vtkInformation* selection,
  int numberOfThreads, const std::function<bool(double, const std::string&)>& progress);

/** Return the names of the blocks of a pyramid's levels, and of level -1 if that is the finest. */
std::vector<std::string> LevelNames(int numberOfLevels, int finest = 0);

/** The levels as the blocks of vtkImagePyramid's output, with its field data. */
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

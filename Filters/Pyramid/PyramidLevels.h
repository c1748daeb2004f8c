// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPyramidLevels_h
#define volumicPyramidLevels_h

#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Image/LevelImage.h"
#include "Core/Image/ThickPart.h"
#include "Core/Image/VoxelValues.h"
#include "Input/ComputationalSpace.h"
#include "Input/ValidVoxels.h"
#include "Pyramid/ImageLevels.h"

#include <array>
#include <cstdint>
#include <map>

namespace volumic
{
/** The levels of an image for the core. The messages of InvalidArgument name the level. */
class PyramidLevels
{
public:
  /** Minimum number of voxels along an axis for a surface. */
  static constexpr int MinimumSize = 8;

  /**
   * @param metric          metric of the computational space
   * @param nanIsBackground false: Load() throws for NaN voxels
   * @throws InvalidArgument if the image is 2D or smaller than MinimumSize along an axis
   */
  PyramidLevels(const ImageLevels& levels, Metric metric, bool nanIsBackground = true);

  int NumberOfLevels() const { return static_cast<int>(this->Levels.size()); }
  const ComputationalSpace& GetComputationalSpace() const { return this->Space; }

  /** Return whether the level has MinimumSize voxels along each axis. Level 0 has. */
  bool HasRoom(int level) const;

  const std::array<int, 3>& SizeOf(int level) const { return this->Sizes[level]; }
  std::int64_t NumberOfVoxels(int level) const;

  /** Return U_h in world units, for level -1 U_0 / T. */
  double UnitInWorld(int level) const { return this->UnitOf(level) * this->Space.WorldUnit(); }
  void SetFactorBelowLevel0(double t) { this->FactorBelow = t; }

  /** Return whether a part of the object has at least a given size at a level (ThickPart.h). */
  bool ContainsPart(int level, const PartSize& least, double isoValue, bool objectIsBright) const;

  /**
   * Return the smallest and the largest valid voxel of a level, in reverse order if there is none.
   */
  std::array<double, 2> Range(int level) const;

  /**
   * Return the voxels of a level, for level -1 those of level 0, until the next call. They are
   * shared, and keep their type (VoxelValues), unless some of them are invalid. `base` becomes the
   * Base of the result, which is subtracted from the voxels, except from floats with a sufficient
   * resolution.
   * @param base       reference value, such as the iso-value
   * @param background value of invalid voxels
   * @throws InvalidArgument if the level is too small, or has voxels that are infinite, too large
   *   for single precision, or NaN without nanIsBackground
   */
  LevelImage Load(int level, double base, double background, Executor& executor);

  /** Argument of ReleaseCoarserThan(). */
  static constexpr int AllLevels = -2;
  /**
   * Release the voxels of coarser levels. Sizes, units and cached ranges remain. AllLevels releases
   * level 0, too.
   */
  void ReleaseCoarserThan(int level);
  bool HasVoxels(int level) const { return this->Levels[level].Image != nullptr; }

private:
  double UnitOf(int level) const;
  ValidVoxels ValidAt(int level, Executor& executor) const;

  std::vector<ImageLevel> Levels; ///< without image and voxels if released
  std::vector<std::array<int, 3>> Sizes;
  double FactorBelow; ///< U_0 over the unit of level -1
  ComputationalSpace Space;
  vtkSmartPointer<vtkDataArray> Loaded; ///< voxels of the last Load()
  LargeVector<float> Filled;            ///< copy of them if some are invalid
  bool NaNIsBackground;
  mutable std::map<int, std::array<double, 2>> Ranges; ///< cached, by level
};
}

#endif

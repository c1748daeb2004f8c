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
/** The levels of an image for the core. All errors are a Refusal whose message names the level. */
class PyramidLevels
{
public:
  /** The fewest voxels along an axis on which a surface can evolve. */
  static constexpr int MinimumSize = 8;

  /**
   * @param metric          metric of the computational space
   * @param nanIsBackground false: Load() throws for NaN voxels
   * @throws Refusal if the image is 2D or smaller than MinimumSize along an axis
   */
  PyramidLevels(const ImageLevels& levels, Metric metric, bool nanIsBackground = true);

  int NumberOfLevels() const { return static_cast<int>(this->Levels.size()); }
  const ComputationalSpace& GetComputationalSpace() const { return this->Space; }

  /** Whether a surface can evolve on the level: MinimumSize along each axis. Level 0 has it. */
  bool HasRoom(int level) const;

  /** Voxels of a level along each axis. */
  const std::array<int, 3>& SizeOf(int level) const { return this->Sizes[level]; }
  std::int64_t NumberOfVoxels(int level) const;

  /** U_h in world units. Level -1, finer than the image, has U_0 / T. */
  double UnitInWorld(int level) const { return this->UnitOf(level) * this->Space.WorldUnit(); }
  void SetFactorBelowLevel0(double t) { this->FactorBelow = t; }

  /**
   * Whether a part of the object, which is above the value (bright) or below, is at least that
   * large at a level (ThickPart.h).
   */
  bool ContainsPart(int level, const PartSize& least, double isoValue, bool objectIsBright) const;

  /**
   * Smallest and largest voxel of a level among those that are valid (ValidVoxels.h); the first is
   * the larger one if none is.
   */
  std::array<double, 2> Range(int level) const;

  /**
   * The voxels of a level, of level 0 for level -1; they stay valid until the next call. They are
   * shared, and read in their own type (VoxelValues), unless some of them are not valid: then they
   * are copied. Floats are taken as they are, unless their differences are small beside their size;
   * of all others `base` is subtracted: it is the Base of the result.
   * @param base       a value of the field that matters, such as the iso-value
   * @param background the value that voxels get which are not valid
   * @throws if the level is under MinimumSize along an axis, or has voxels that are infinite or too
   *         large for single precision, or NaN where these are refused.
   */
  LevelImage Load(int level, double base, double background, Executor& executor);

  /** Coarser than none. */
  static constexpr int AllLevels = -2;
  /**
   * Lets go of the voxels of the levels that are coarser: no more than sizes, units and ranges that
   * were asked for is known of them afterwards. Of level 0 the voxels stay, unless AllLevels go.
   */
  void ReleaseCoarserThan(int level);
  /** Whether the voxels of a level are still there. */
  bool HasVoxels(int level) const { return this->Levels[level].Image != nullptr; }

private:
  double UnitOf(int level) const;
  ValidVoxels ValidAt(int level, Executor& executor) const;

  std::vector<ImageLevel> Levels; ///< without image and voxels where these were let go
  std::vector<std::array<int, 3>> Sizes;
  double FactorBelow; ///< U_0 over the unit of level -1
  ComputationalSpace Space;
  vtkSmartPointer<vtkDataArray> Loaded; ///< what the result of the last Load() refers to
  LargeVector<float> Filled;            ///< or this
  bool NaNIsBackground;
  mutable std::map<int, std::array<double, 2>> Ranges; ///< by level, once asked for
};
}

#endif

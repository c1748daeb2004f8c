// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEdgeLevels_h
#define volumicEdgeLevels_h

#include "Core/Common/Monitor.h"
#include "Pyramid/PyramidLevels.h"

#include <array>
#include <cstdint>
#include <memory>

class vtkInformation;
class vtkMultiBlockDataSet;

namespace volumic
{
/**
 * The levels of the map of edges. Where all blocks carry the array these are taken; else the
 * pyramid of the array of block 0 is made, by the factor that the blocks tell.
 */
class EdgeLevels
{
public:
  /**
   * @param blocks    the levels of the voxels
   * @param selection of the map, as GetInputArrayInformation()
   * @param goOn      asked where the map's pyramid is made; after false there are no levels
   * @throws std::invalid_argument if no array is selected or block 0 has none of that name.
   */
  EdgeLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection, int numberOfThreads,
    const ProgressQuestion& goOn);

  /**
   * The voxels of the map, for LevelImage::Edges; valid until the next call.
   * @throws std::invalid_argument if the level has not the size of the voxels'.
   */
  VoxelValues Load(int level, const std::array<int, 3>& size, Executor& executor);

  /** PyramidLevels::HashOfVoxels() of all levels; 0 after a stop. */
  std::uint64_t HashOfVoxels(Executor& threads) const;

  /** Lets go of the voxels of coarser levels, which cannot be loaded any more. */
  void ReleaseCoarserThan(int level)
  {
    if (this->Levels)
    {
      this->Levels->ReleaseCoarserThan(level);
    }
  }

private:
  std::unique_ptr<PyramidLevels> Levels; ///< null after a stop
};
}

#endif

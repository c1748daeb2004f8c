// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelBricks_h
#define volumicLabelBricks_h

#include "Core/Common/Executor.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Labels/LabelMap.h"

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
struct LabelExtent
{
  std::int64_t Voxels = 0;
  VoxelBox Bricks; ///< smallest box of bricks that contains all voxels of the object
};

/**
 * Extents of the objects of a label map in bricks of 4 x 4 x 4 voxels. An object is processed in
 * the bricks of its extent only, so that the time does not grow with the number of objects times
 * the size of the map. The extent of object 0 includes the bricks that end outside the map.
 */
class LabelBricks
{
public:
  static constexpr int Side = 4; ///< edge length of a brick in voxels

  /**
   * @param map    must outlive this object
   * @param inside box in which voxels are counted; voxels beyond it are padding
   */
  LabelBricks(const LabelMap& map, Executor& executor, const VoxelBox& inside);
  LabelBricks(const LabelMap& map, Executor& executor)
    : LabelBricks(map, executor, VoxelBox::Of(map.Size()))
  {
  }

  const LabelMap& Map() const { return *this->Labels; }
  const VoxelBox& Inside() const { return this->Counted; }
  const std::array<int, 3>& Size() const { return this->Count; }
  const LabelExtent& ExtentOf(int object) const { return this->Extents[object]; }

private:
  const LabelMap* Labels;
  VoxelBox Counted;
  std::array<int, 3> Count;
  std::vector<LabelExtent> Extents;
};
}

#endif

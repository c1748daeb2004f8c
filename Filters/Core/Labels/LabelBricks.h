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
/** Which bricks an object is in. */
struct LabelExtent
{
  std::int64_t Voxels = 0;
  VoxelBox Bricks; ///< the box of bricks that have voxels of it
};

/**
 * A label map in bricks of 4 x 4 x 4 voxels, from voxel 0 on: in which of them each object is. What
 * is done about an object is done in the bricks about it only, so that time does not grow with the
 * number of objects times the size of the map. Bricks that end outside the map have object 0, too.
 */
class LabelBricks
{
public:
  static constexpr int Side = 4; ///< of a brick, in voxels

  /**
   * The map must outlive it.
   * @param inside where voxels are counted: what is beyond only goes on with what is there
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

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
 * A label map in bricks of 4 x 4 x 4 voxels, from voxel 0 on: which objects each of them has. What
 * is done about an object is done in the bricks about its boundary only, so that time grows with
 * the boundaries of the objects, and not with their number times the size of the map.
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

  /** The objects of a brick, sorted; 0 is one of them where it has other voxels or ends outside. */
  struct Range
  {
    const LabelMap::Number* First;
    const LabelMap::Number* Last;
    const LabelMap::Number* begin() const { return this->First; }
    const LabelMap::Number* end() const { return this->Last; }
    bool Has(LabelMap::Number object) const;
  };
  /** Of a brick within the map. */
  Range ObjectsIn(int i, int j, int k) const;

private:
  void FindObjects(Executor& executor);
  void FindExtents(Executor& executor);

  const LabelMap* Labels;
  VoxelBox Counted;
  std::array<int, 3> Count;
  std::vector<std::size_t> First; ///< of each brick, in Objects
  std::vector<LabelMap::Number> Objects;
  std::vector<LabelExtent> Extents;
};
}

#endif

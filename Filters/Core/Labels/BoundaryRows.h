// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBoundaryRows_h
#define volumicBoundaryRows_h

#include "Core/Common/Executor.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Labels/LabelBricks.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The voxels about the boundary of an object, brick by brick: at least one brick beyond each voxel
 * of the boundary, within a box about the object, which may reach beyond the map by a brick.
 */
class BoundaryRows
{
public:
  /** @param within bricks: there only, and not beyond them by more than one */
  BoundaryRows(const LabelBricks& bricks, int object, const VoxelBox& within);
  BoundaryRows(const LabelBricks& bricks, int object)
    : BoundaryRows(bricks, object, VoxelBox::Of(bricks.Size()))
  {
  }

  /** The box, in voxels of the map, which is one of whole bricks. */
  const VoxelBox& Box() const { return this->Voxels; }

  /** The same voxels and those so many further along an axis, to whole bricks; within the box. */
  BoundaryRows Grown(int axis, int voxels) const;

  /** Whether a brick of the box is among them; they are numbered from its first one. */
  bool Has(int i, int j, int k) const
  {
    return this->Mask[static_cast<std::size_t>(VoxelBox::Of(this->Count).NumberOf(i, j, k))] != 0;
  }

  /**
   * Calls visit(i, j, k, count) for each row along x: its first voxel, of the map, and how many
   * there are. Rows of one layer of bricks on one thread, in their order.
   */
  template <typename Visitor>
  void For(Executor& executor, Visitor&& visit) const
  {
    ForSpans(executor, static_cast<std::size_t>(this->Count[2]), 1,
      [&](std::size_t layer, std::size_t, std::size_t)
      { this->ForLayer(static_cast<int>(layer), visit); });
  }

  int NumberOfLayers() const { return this->Count[2]; }

  /** The same for one layer of bricks. */
  template <typename Visitor>
  void ForLayer(int layer, Visitor&& visit) const
  {
    constexpr int side = LabelBricks::Side;
    for (int c = 0; c < side; ++c)
    {
      for (int j = 0; j < this->Count[1]; ++j)
      {
        for (int b = 0; b < side; ++b)
        {
          this->ForRow(layer, j, [&](int first, int end)
            {
              visit(this->Voxels.First[0] + first * side, this->Voxels.First[1] + j * side + b,
                this->Voxels.First[2] + layer * side + c, (end - first) * side);
            });
        }
      }
    }
  }

private:
  /** Calls visit(first, end) for each run of bricks of a row. */
  template <typename Visitor>
  void ForRow(int layer, int j, Visitor&& visit) const
  {
    for (int i = 0; i < this->Count[0]; ++i)
    {
      const int first = i;
      while (i < this->Count[0] && this->Has(i, j, layer))
      {
        ++i;
      }
      if (i > first)
      {
        visit(first, i);
      }
    }
  }

  VoxelBox Voxels;
  std::array<int, 3> Count = { 0, 0, 0 }; ///< bricks of the box
  std::vector<unsigned char> Mask;
};
}

#endif

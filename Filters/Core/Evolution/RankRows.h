// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRankRows_h
#define volumicRankRows_h

#include "Core/Common/Communicator.h"
#include "Core/Image/VoxelBox.h"

#include <array>

namespace volumic
{
/**
 * The rows of voxels that a rank looks through: whole ones, along x. Each row of the image is of
 * one rank; a rank may have none. It has the voxels beside its rows, too, and the vertices of the
 * surface that are less than 8 delta from them, with their neighbours.
 *
 * Who is given one must call what it is given to on all ranks.
 */
struct RankRows
{
  Communicator& Ranks;
  VoxelBox Rows;

  /** Whether a row beside one of its own is another rank's. @param size of the image */
  bool IsAtBorder(int j, int k, const std::array<int, 3>& size) const
  {
    const auto isAt = [&](int axis, int place)
    {
      return (place == this->Rows.First[axis] && place > 0) ||
        (place + 1 == this->Rows.End[axis] && place + 1 < size[axis]);
    };
    return isAt(1, j) || isAt(2, k);
  }
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelBricks.h"

#include <algorithm>
#include <mutex>

namespace volumic
{
LabelBricks::LabelBricks(const LabelMap& map, Executor& executor, const VoxelBox& inside)
  : Labels(&map), Counted(inside), Extents(static_cast<std::size_t>(map.NumberOfObjects) + 1)
{
  std::transform(map.Size().begin(), map.Size().end(), this->Count.begin(),
    [](int voxels) { return (voxels + Side - 1) / Side; });
  for (int axis = 0; axis < 3; ++axis)
  {
    if (map.Size()[axis] % Side != 0)
    {
      VoxelBox last = VoxelBox::Of(this->Count);
      last.First[axis] = this->Count[axis] - 1;
      this->Extents[0].Bricks = this->Extents[0].Bricks.With(last);
    }
  }
  std::mutex mutex;
  // The sums are of integers, so that they do not depend on the order of the threads.
  executor.For(static_cast<std::size_t>(map.NumberOfLayers()), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<LabelExtent> own(this->Extents.size());
      for (std::size_t layer = begin; layer < end; ++layer)
      {
        map.ForParts(map.Layer(static_cast<int>(layer)),
          [&](const VoxelBox& part, LabelMap::Number object)
          {
            VoxelBox bricks;
            for (int axis = 0; axis < 3; ++axis)
            {
              bricks.First[axis] = part.First[axis] / Side;
              bricks.End[axis] = (part.End[axis] - 1) / Side + 1;
            }
            own[object].Voxels += part.CommonWith(this->Counted).Count();
            own[object].Bricks = own[object].Bricks.With(bricks);
          });
      }
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t object = 0; object < own.size(); ++object)
      {
        this->Extents[object].Voxels += own[object].Voxels;
        this->Extents[object].Bricks = this->Extents[object].Bricks.With(own[object].Bricks);
      }
    });
}
}

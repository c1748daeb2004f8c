// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicForVoxels_h
#define volumicForVoxels_h

#include <array>

namespace volumic
{
/** Call visit(i, j, k) for each voxel in [first, end), i fastest. */
template <typename Visit>
void ForBox(const std::array<int, 3>& first, const std::array<int, 3>& end, Visit&& visit)
{
  for (int k = first[2]; k < end[2]; ++k)
  {
    for (int j = first[1]; j < end[1]; ++j)
    {
      for (int i = first[0]; i < end[0]; ++i)
      {
        visit(i, j, k);
      }
    }
  }
}

/** Call visit(i, j, k) for each voxel of a volume, i fastest. */
template <typename Visit>
void ForVoxels(const std::array<int, 3>& size, Visit&& visit)
{
  ForBox({ 0, 0, 0 }, size, visit);
}
}

#endif

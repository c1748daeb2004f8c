// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThickPart_h
#define volumicThickPart_h

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Voxels that a part of the object must have to hold a surface at its level, if they lie in cubes
 * of 2 x 2 x 2 of its voxels. Found by experiment: a surface that shrinks from outside vanishes in
 * about half of the balls of 12 to 31 such voxels, and in none of 36 and more; rods and plates
 * that consist of such cubes hold it always.
 */
constexpr int VoxelsThatHold = 36;

/**
 * Whether the marked voxels (x fastest, not 0) have a part that consists of cubes of 2 x 2 x 2 of
 * them, joined by faces, and has at least so many voxels. Thinner parts don't count.
 */
bool HasThickPart(
  const std::vector<std::uint8_t>& marks, const std::array<int, 3>& size, int minimum);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelHash_h
#define volumicVoxelHash_h

#include "Core/Common/Executor.h"
#include "Core/Image/VoxelBox.h"

#include <cstddef>
#include <cstdint>

namespace volumic
{
/**
 * 64 bits that tell voxels apart, as ContentHash() does: a sum over voxels, of their bytes and of
 * where they are in their image. So whoever holds a part adds up that part; modulo 2^64 the sum of
 * all parts is the hash of the whole. The same for any executor.
 * @param voxels those of the box `held`, x fastest
 * @param bytes  of a voxel: 1, 2, 4 or 8
 * @param part   the box of which the hash is, within `held`
 * @param image  the box of the whole image
 */
std::uint64_t HashOfVoxels(const void* voxels, std::size_t bytes, const VoxelBox& held,
  const VoxelBox& part, const VoxelBox& image, Executor& executor = OnThisThread());
}

#endif

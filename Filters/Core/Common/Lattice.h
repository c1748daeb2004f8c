// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLattice_h
#define volumicLattice_h

#include <array>
#include <cstdint>

namespace volumic
{
/**
 * Hash key of a lattice point: the last 21 bits of each index. Keys are unique in a range of 2^21
 * along each axis.
 */
inline std::uint64_t LatticeKey(std::int64_t i, std::int64_t j, std::int64_t k)
{
  constexpr int bits = 21;
  constexpr std::int64_t mask = (std::int64_t(1) << bits) - 1;
  return static_cast<std::uint64_t>(i & mask) << 2 * bits |
    static_cast<std::uint64_t>(j & mask) << bits | static_cast<std::uint64_t>(k & mask);
}

/** Indices of a point of a cubic lattice. */
using LatticePoint = std::array<int, 3>;
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLattice_h
#define volumicLattice_h

#include <array>
#include <cstdint>

namespace volumic
{
/**
 * Three integers as one number, for maps of places on a lattice: the last 21 bits of each, which
 * hold every lattice that memory holds. No two places of a range of 2^21 along each axis have the
 * same key.
 */
inline std::uint64_t LatticeKey(std::int64_t i, std::int64_t j, std::int64_t k)
{
  constexpr int bits = 21;
  constexpr std::int64_t mask = (std::int64_t(1) << bits) - 1;
  return static_cast<std::uint64_t>(i & mask) << 2 * bits |
    static_cast<std::uint64_t>(j & mask) << bits | static_cast<std::uint64_t>(k & mask);
}

/**
 * A point of a body-centred cubic lattice, in halves of its pitch: all even, a corner of a cube, or
 * all odd, the middle of one. Its tetrahedra have two corners of each kind, its cells (CellLattice)
 * lie about its points.
 */
using LatticePoint = std::array<int, 3>;

inline std::uint64_t LatticeKey(const LatticePoint& p)
{
  return LatticeKey(p[0], p[1], p[2]);
}
/** Of an edge, or a triangle, of the lattice: no other one has its middle. */
inline std::uint64_t LatticeKey(const LatticePoint& a, const LatticePoint& b)
{
  return LatticeKey(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}
inline std::uint64_t LatticeKey(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c)
{
  return LatticeKey(a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]);
}

/**
 * An edge from a corner of a cube to the next one, with the middles of the four cubes about it, in
 * turn. Its ends and two that follow each other are a tetrahedron: so each belongs to one edge.
 */
struct LatticeEdge
{
  LatticePoint From;
  LatticePoint To;
  std::array<LatticePoint, 4> About;

  LatticeEdge(const LatticePoint& from, int axis) : From(from), To(from)
  {
    this->To[axis] += 2;
    for (int turn = 0; turn < 4; ++turn)
    {
      this->About[turn] = from;
      this->About[turn][axis] += 1;
      this->About[turn][(axis + 1) % 3] += turn == 0 || turn == 3 ? -1 : 1;
      this->About[turn][(axis + 2) % 3] += turn == 0 || turn == 1 ? -1 : 1;
    }
  }
};
}

#endif

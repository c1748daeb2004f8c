// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLatticeInside_h
#define volumicLatticeInside_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Lattice.h"
#include "Core/Mesh/RowCrossing.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Which points of a body-centred cubic lattice a closed surface encloses, layer by layer: the
 * winding number is counted along the rows of points. All points of the outermost layers are
 * outside. Lengths are those of the surface's points.
 */
class LatticeInside
{
public:
  /** The lattice is laid over the surface; `pitch` is the side of its cubes. */
  LatticeInside(const IndexedSurface& surface, double pitch);

  /** Finds what is enclosed in a layer; layers must come in order, the last three are kept. */
  void Fill(std::int64_t k);

  const std::array<std::int64_t, 3>& Size() const { return this->Count; }
  Point PlaceOf(const LatticePoint& p) const
  {
    Point place;
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = this->Origin[axis] + this->Pitch * (0.5 * p[axis]);
    }
    return place;
  }
  bool IsInside(const LatticePoint& p) const
  {
    const int i = p[0] >> 1;
    return this->Word(p[0] & 1, p[1] >> 1, p[2] >> 1, i / WordSize) >> (i % WordSize) & 1u;
  }

  /** Points of a row are looked at this many at a time. */
  static constexpr std::int64_t WordSize = 64;
  std::int64_t WordsInRow() const { return this->Words; }
  /** Whether all cubes at word w of the row j of layer k are on one side. */
  bool IsUniform(std::int64_t w, std::int64_t j, std::int64_t k) const;

  /** About one per squared pitch of the surface. */
  std::size_t NumberOfCrossings() const
  {
    return this->Crossings[0].size() + this->Crossings[1].size();
  }

private:
  static constexpr std::int64_t LayersKept = 3;

  std::size_t PlaceOfWord(int kind, std::int64_t j, std::int64_t k, std::int64_t w) const
  {
    return static_cast<std::size_t>(
      ((kind * LayersKept + k % LayersKept) * this->Count[1] + j) * this->Words + w);
  }
  std::uint64_t Word(int kind, std::int64_t j, std::int64_t k, std::int64_t w) const
  {
    return this->Bits[this->PlaceOfWord(kind, j, k, w)];
  }

  double Pitch;
  Point Origin;
  std::array<std::int64_t, 3> Count; ///< Points along each axis.
  std::int64_t Words;                ///< Of bits in a row.
  std::vector<std::uint64_t> Bits;
  std::vector<RowGrid::Crossing> Crossings[2]; ///< Of the two kinds of points, row by row.
  std::size_t Next[2] = { 0, 0 };              ///< The first of them in the layer to be filled.
};
}

#endif

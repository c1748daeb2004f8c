// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicPieceOfSurface_h
#define volumicPieceOfSurface_h

#include "Core/Common/Communicator.h"
#include "Core/Common/ScratchMemory.h"

#include <cstddef>

namespace volumic
{
/**
 * Of which surface an IndexedSurface is a piece: by default of itself, as a whole. Else each of
 * several ranks has a piece, which may be empty: triangles that follow each other in the whole,
 * those of rank 0 first, and the points that these have, in the order of the whole.
 *
 * Who is given one must call what it is given to on all ranks.
 */
struct PieceOfSurface
{
  /** Bits of Roles. */
  enum : unsigned char
  {
    IsCounted = 1, ///< Of the pieces that have the point this is the first.
    IsShared = 2   ///< Other pieces have it, too.
  };

  Communicator* Ranks = &OnThisRank();
  int FirstTriangle = 0;            ///< Its number in the whole.
  LargeVector<int> Ids;             ///< By point its number in the whole; empty: the same.
  LargeVector<unsigned char> Roles; ///< By point; empty: each is counted.

  bool IsWhole() const { return this->Ranks->NumberOfRanks() == 1; }
  /** Each point of the whole counts in one piece. */
  bool Counts(std::size_t point) const
  {
    return this->Roles.empty() || (this->Roles[point] & IsCounted);
  }
};
}

#endif

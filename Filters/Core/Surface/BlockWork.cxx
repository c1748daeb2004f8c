// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// How long the visits of blocks take, for ranks that share them: RankBlocks::Balance.

#include "Core/Surface/SurfaceBlocks.h"

namespace volumic
{
namespace
{
/** Of the iterations of a visit, for each vertex, */
constexpr int LooksAtVertex = 7;
/** and for one that has a way to go. */
constexpr int LooksAtFar = 30;
// Edits take as long as so many looks, each, as measured on the skull at 512^3:
constexpr int LooksAtMerge = 200;
constexpr int LooksAtFlip = 45;
constexpr int LooksAtSplit = 18;
}

void SurfaceBlocks::NoteWork(const BlockVisit& visit)
{
  if (visit.Looks > 0) // Else it was not one of those that are to be shared.
  {
    OfBlock& own = this->All[visit.Block];
    const EditCounts& counts = visit.Share.Counts;
    own.Far = 0;
    own.Work = visit.Looks +
      static_cast<std::int64_t>(LooksAtMerge) * (counts.Merges + counts.Cuts) +
      static_cast<std::int64_t>(LooksAtFlip) * counts.Flips +
      static_cast<std::int64_t>(LooksAtSplit) * (counts.Splits + counts.Collapses);
  }
}

std::int64_t SurfaceBlocks::WorkOf(int block, bool onlyActive) const
{
  const OfBlock& own = this->All[block];
  if (onlyActive && !this->HasActive(block))
  {
    return 0;
  }
  return onlyActive && own.Work >= 0
    ? own.Work
    : static_cast<std::int64_t>(LooksAtVertex) * own.Vertices.size() + LooksAtFar * own.Far;
}

void SurfaceBlocks::ForgetWork()
{
  for (OfBlock& block : this->All)
  {
    block.Work = -1;
  }
}

void SurfaceBlocks::ExpectMoves(const std::vector<int>& vertices)
{
  for (const int v : vertices)
  {
    ++this->All[this->State.Block[v]].Far;
  }
}

void SurfaceBlocks::Write(MessageWriter& message, int block) const
{
  const OfBlock& own = this->All[block];
  message.AddArray(own.Places.Free);
  message.Add(own.Unused);
  message.Add(own.Taken);
  message.Add(own.Far);
  message.Add(own.Work);
}

void SurfaceBlocks::Read(MessageReader& message, int block)
{
  OfBlock& own = this->All[block];
  message.TakeArray(own.Places.Free);
  own.Unused = message.Take<UnusedPlaces>();
  own.Taken = message.Take<int>();
  own.Far = message.Take<int>();
  own.Work = message.Take<std::int64_t>();
}
}

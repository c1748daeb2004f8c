// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Which rank gets which block: RankBlocks::ChooseOwners.

#include "Core/Surface/RankBlocks.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace volumic
{
namespace
{
/** Rows of blocks, between two places along y and two along z. */
struct RowsOfBlocks
{
  int Begin[2];
  int End[2];
};

/** Cuts boxes of rows of blocks into halves of as many vertices as their ranks. */
class OwnerChoice
{
public:
  OwnerChoice(const SurfaceBlocks::Frame& frame, const std::vector<int>& vertices)
    : Frame(frame)
    , Vertices(static_cast<std::size_t>(frame.Size[1]) * frame.Size[2], 0)
    , OwnerOfRow(this->Vertices.size(), 0)
  {
    for (std::size_t block = 0; block < vertices.size(); ++block)
    {
      this->Vertices[block / frame.Size[0]] += vertices[block];
    }
  }

  void Cut(const RowsOfBlocks& rows, int firstRank, int ranks)
  {
    if (ranks == 1)
    {
      this->ForRows(rows, [&](std::size_t row) { this->OwnerOfRow[row] = firstRank; });
      return;
    }
    const int lower = ranks / 2;
    const double wanted = static_cast<double>(this->Count(rows)) * lower / ranks;
    RowsOfBlocks best = rows;
    best.End[1] = best.Begin[1]; // Nothing, where there is nothing to cut.
    int bestAxis = 1;
    double least = -1.;
    for (const int axis : { 1, 0 })
    {
      for (int at = rows.Begin[axis] + 1; at < rows.End[axis]; ++at)
      {
        RowsOfBlocks part = rows;
        part.End[axis] = at;
        const double off = std::abs(static_cast<double>(this->Count(part)) - wanted);
        if (least < 0. || off < least)
        {
          least = off;
          best = part;
          bestAxis = axis;
        }
      }
    }
    RowsOfBlocks rest = rows;
    rest.Begin[bestAxis] = best.End[bestAxis];
    this->Cut(best, firstRank, lower);
    this->Cut(rest, firstRank + lower, ranks - lower);
  }

  std::vector<int> Owners(std::size_t blocks) const
  {
    std::vector<int> owners(blocks);
    for (std::size_t block = 0; block < blocks; ++block)
    {
      owners[block] = this->OwnerOfRow[block / this->Frame.Size[0]];
    }
    return owners;
  }

private:
  template <typename Visit>
  void ForRows(const RowsOfBlocks& rows, Visit&& visit) const
  {
    for (int z = rows.Begin[1]; z < rows.End[1]; ++z)
    {
      for (int y = rows.Begin[0]; y < rows.End[0]; ++y)
      {
        visit(static_cast<std::size_t>(z) * this->Frame.Size[1] + y);
      }
    }
  }
  std::int64_t Count(const RowsOfBlocks& rows) const
  {
    std::int64_t count = 0;
    this->ForRows(rows, [&](std::size_t row) { count += this->Vertices[row]; });
    return count;
  }

  const SurfaceBlocks::Frame& Frame;
  std::vector<std::int64_t> Vertices; ///< By row.
  std::vector<int> OwnerOfRow;
};
}

std::vector<int> RankBlocks::ChooseOwners(
  const SurfaceBlocks::Frame& frame, const std::vector<int>& vertices, int ranks)
{
  OwnerChoice choice(frame, vertices);
  choice.Cut({ { 0, 0 }, { frame.Size[1], frame.Size[2] } }, 0, ranks);
  return choice.Owners(vertices.size());
}
}

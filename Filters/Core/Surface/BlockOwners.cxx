// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Which rank gets which block: RankBlocks::ChooseOwners for a start, BalancedOwners from then on.

#include "Core/Surface/RankBlocks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numeric>
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

/** Cuts sets of blocks into halves of as much work as their ranks. */
class BalancedChoice
{
public:
  /** @param before the owners so far, of whom as many as possible shall stay it */
  BalancedChoice(const SurfaceBlocks& blocks, const std::vector<RankBlocks::Load>& loads,
    const std::vector<int>& before)
    : Blocks(blocks)
    , Loads(loads)
    , Before(before)
    , Owners(before)
  {
  }

  std::vector<int> Among(int ranks)
  {
    std::vector<int> all;
    for (int block = 0; block < this->Blocks.NumberOfBlocks(); ++block)
    {
      if (this->Loads[block].Vertices > 0)
      {
        all.push_back(block);
      }
    }
    this->Cut(std::move(all), 0, ranks);
    return std::move(this->Owners);
  }

private:
  /** Ranks from the first one on share these blocks. */
  void Cut(std::vector<int> blocks, int firstRank, int ranks)
  {
    if (ranks == 1)
    {
      for (const int block : blocks)
      {
        this->Owners[block] = firstRank;
      }
      return;
    }
    const int lower = ranks / 2;
    std::vector<int> best;
    std::ptrdiff_t half = 0;
    std::int64_t most = -1;
    for (const int axis : { 2, 1, 0 }) // Slabs of the image, where nothing speaks for others.
    {
      this->SortAlong(axis, blocks);
      const std::ptrdiff_t count = this->CountOfShare(blocks, lower, ranks);
      const auto at = blocks.begin() + count;
      const std::int64_t staying = this->CountOf(blocks.begin(), at, firstRank, lower) +
        this->CountOf(at, blocks.end(), firstRank + lower, ranks - lower);
      if (staying > most)
      {
        most = staying;
        half = count;
        best = blocks;
      }
    }
    this->Cut({ best.begin(), best.begin() + half }, firstRank, lower);
    this->Cut({ best.begin() + half, best.end() }, firstRank + lower, ranks - lower);
  }

  /** How many of the blocks belong to these ranks. */
  template <typename Iterator>
  std::int64_t CountOf(Iterator begin, Iterator end, int firstRank, int ranks) const
  {
    return std::count_if(begin, end, [&](int block)
      { return this->Before[block] >= firstRank && this->Before[block] < firstRank + ranks; });
  }

  void SortAlong(int axis, std::vector<int>& blocks) const
  {
    std::sort(blocks.begin(), blocks.end(),
      [&](int a, int b)
      {
        std::array<int, 3> ofA = this->Blocks.PlaceOf(a);
        std::array<int, 3> ofB = this->Blocks.PlaceOf(b);
        std::swap(ofA[axis], ofA[2]);
        std::swap(ofB[axis], ofB[2]);
        return std::lexicographical_compare(ofA.rbegin(), ofA.rend(), ofB.rbegin(), ofB.rend());
      });
  }

  /** Where there is nothing to do, vertices count. */
  std::int64_t WeightOf(int block) const
  {
    return 16 * this->Loads[block].Work + this->Loads[block].Vertices;
  }

  /** How many of the blocks, from the first on, have about this share of their work. */
  std::ptrdiff_t CountOfShare(const std::vector<int>& blocks, int lower, int ranks) const
  {
    const std::int64_t all = std::accumulate(blocks.begin(), blocks.end(), std::int64_t(0),
      [this](std::int64_t sum, int block) { return sum + this->WeightOf(block); });
    std::int64_t sum = 0;
    std::ptrdiff_t count = 0;
    // A block goes to those that have more of it.
    while (count < static_cast<std::ptrdiff_t>(blocks.size()) &&
      (2 * sum + this->WeightOf(blocks[count])) * ranks < 2 * all * lower)
    {
      sum += this->WeightOf(blocks[count++]);
    }
    return count;
  }

  const SurfaceBlocks& Blocks;
  const std::vector<RankBlocks::Load>& Loads; ///< By block.
  const std::vector<int>& Before;
  std::vector<int> Owners;
};
}

std::vector<int> RankBlocks::ChooseOwners(
  const SurfaceBlocks::Frame& frame, const std::vector<int>& vertices, int ranks)
{
  OwnerChoice choice(frame, vertices);
  choice.Cut({ { 0, 0 }, { frame.Size[1], frame.Size[2] } }, 0, ranks);
  return choice.Owners(vertices.size());
}

std::vector<int> RankBlocks::BalancedOwners(const SurfaceBlocks& blocks,
  const std::vector<Load>& loads, const std::vector<int>& before, int ranks)
{
  return BalancedChoice(blocks, loads, before).Among(ranks);
}

std::int64_t RankBlocks::WorkOfSweep(
  const std::vector<Load>& loads, const std::vector<int>& owners, int ranks)
{
  std::vector<std::int64_t> ofRanks(static_cast<std::size_t>(ranks), 0);
  for (std::size_t block = 0; block < loads.size(); ++block)
  {
    ofRanks[owners[block]] += loads[block].Work;
  }
  return *std::max_element(ofRanks.begin(), ofRanks.end());
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Parts of lost voxels that go on from the rows of one rank to those of another: LostVoxels.

#include "Core/Common/DisjointSets.h"
#include "Core/Common/RankLists.h"
#include "Core/Evolution/LostVoxels.h"
#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace volumic
{
namespace
{
/** What a rank has of a part. */
struct PieceOfPart
{
  std::int64_t First; ///< Voxel.
  std::int64_t Voxels;
};

/** The pieces of all ranks, on rank 0. */
class PieceJoin
{
public:
  PieceJoin(const std::vector<Message>& ofRanks, const std::array<int, 3>& size)
    : Size(size)
  {
    for (const Message& message : ofRanks)
    {
      MessageReader reader(message);
      const std::vector<PieceOfPart> pieces = reader.TakeVector<PieceOfPart>();
      for (VoxelRun run : reader.TakeVector<VoxelRun>())
      {
        run.Part += static_cast<int>(this->FirstPiece.back());
        this->Border.push_back(run);
      }
      this->Pieces.insert(this->Pieces.end(), pieces.begin(), pieces.end());
      this->FirstPiece.push_back(this->Pieces.size());
    }
  }

  /** @return to each rank: how many parts there are, and which its pieces are of. */
  std::vector<Message> Answers(std::int64_t minimumSize)
  {
    DisjointSets joined = this->JoinedPieces();
    std::vector<std::int64_t> whole(this->Pieces.size(), 0);
    for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
    {
      whole[joined.Find(static_cast<int>(piece))] += this->Pieces[piece].Voxels;
    }
    std::vector<int> order(this->Pieces.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
      [this](int a, int b) { return this->Pieces[a].First < this->Pieces[b].First; });
    int parts = 0;
    std::vector<int> number(this->Pieces.size(), VoxelRun::NoPart); // By root.
    for (const int piece : order)
    {
      const int root = joined.Find(piece);
      if (whole[root] >= minimumSize && number[root] == VoxelRun::NoPart)
      {
        number[root] = parts++;
      }
    }
    std::vector<Message> answers;
    for (std::size_t rank = 0; rank + 1 < this->FirstPiece.size(); ++rank)
    {
      std::vector<int> numbers;
      for (std::size_t i = this->FirstPiece[rank]; i < this->FirstPiece[rank + 1]; ++i)
      {
        numbers.push_back(number[joined.Find(static_cast<int>(i))]);
      }
      MessageWriter writer;
      writer.Add(parts);
      writer.AddArray(numbers);
      answers.push_back(writer.Take());
    }
    return answers;
  }

private:
  DisjointSets JoinedPieces()
  {
    DisjointSets joined(this->Pieces.size());
    std::vector<VoxelRun>& runs = this->Border;
    std::sort(runs.begin(), runs.end(),
      [](const VoxelRun& a, const VoxelRun& b) { return a.First < b.First; });
    const VoxelNumbers numbers(this->Size);
    const RunRange all = { 0, runs.size() };
    for (const int axis : { 1, 2 })
    {
      VisitOverlaps(runs, all, runs, all, numbers.Stride(axis),
        [&](std::size_t i, std::size_t j)
        {
          // Beyond the last row of a layer lies the first one of the next.
          if (axis == 2 || numbers.PlaceOf(runs[i].First)[1] + 1 < this->Size[1])
          {
            joined.Join(runs[i].Part, runs[j].Part);
          }
        });
    }
    return joined;
  }

  const std::array<int, 3> Size;
  std::vector<PieceOfPart> Pieces;               ///< Of all ranks, one after the other.
  std::vector<std::size_t> FirstPiece = { 0 };   ///< Of each rank, and the end of the last.
  std::vector<VoxelRun> Border;                  ///< Of all ranks; Part: the piece.
};
}

void LostVoxels::JoinRanks(std::int64_t minimumSize, const RankRows& part)
{
  std::vector<PieceOfPart> pieces(static_cast<std::size_t>(this->Parts), { -1, 0 });
  std::vector<VoxelRun> border;
  const VoxelNumbers numbers(this->Size);
  for (const std::vector<VoxelRun>& slab : this->Runs)
  {
    for (const VoxelRun& run : slab)
    {
      PieceOfPart& piece = pieces[static_cast<std::size_t>(run.Part)];
      piece.First = piece.First < 0 ? run.First : piece.First; // Runs are in order.
      piece.Voxels += run.Length;
      const std::array<int, 3> place = numbers.PlaceOf(run.First);
      if (part.IsAtBorder(place[1], place[2], this->Size))
      {
        border.push_back(run);
      }
    }
  }
  MessageWriter writer;
  writer.AddArray(pieces);
  writer.AddArray(border);
  const std::vector<Message> ofRanks = part.Ranks.Gather(writer.Take());
  const Message answer =
    Scatter(part.Ranks, PieceJoin(ofRanks, this->Size).Answers(minimumSize));
  MessageReader reader(answer);
  this->Parts = reader.Take<int>();
  const std::vector<int> number = reader.TakeVector<int>();
  for (std::vector<VoxelRun>& runs : this->Runs)
  {
    for (VoxelRun& run : runs)
    {
      run.Part = number[static_cast<std::size_t>(run.Part)];
    }
    runs.erase(std::remove_if(runs.begin(), runs.end(),
                 [](const VoxelRun& run) { return run.Part == VoxelRun::NoPart; }),
      runs.end());
  }
}
}

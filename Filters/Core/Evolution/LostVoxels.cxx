// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostVoxels.h"

#include "Core/Common/Communicator.h"
#include "Core/Common/DisjointSets.h"
#include "Core/Common/JoinLabels.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/SlabSearch.h"
#include "Core/Evolution/VerticesOfSlabs.h"
#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace volumic
{
namespace
{
/** Layers of a slab. */
constexpr int LayersOfSlab = 8;
/** Slabs between two questions whether to go on. */
constexpr std::size_t SlabsPerBatch = 32;
static_assert(VoxelRun::NoPart == JoinedSets::None, "labels become numbers of parts");

/** Whether a run lies beside another slab, or beside rows of another rank. */
bool IsAtBorder(const VoxelRun& run, const RankRows& own, const std::array<int, 3>& size)
{
  const std::array<int, 3> place = VoxelNumbers(size).PlaceOf(run.First);
  const int k = place[2];
  return (k % LayersOfSlab == 0 && k > 0) ||
    (k % LayersOfSlab == LayersOfSlab - 1 && k + 1 < size[2]) ||
    own.IsAtBorder(place[1], k, size);
}

/**
 * Numbers the parts of the layers [begin, end), in the order of their first voxels, and leaves out
 * those that are too small and end within them. @return the others
 */
std::vector<SetPiece> NumberParts(std::vector<VoxelRun>& runs, const std::array<int, 3>& size,
  int begin, int end, const RankRows& own, std::int64_t minimumSize)
{
  const VoxelNumbers numbers(size);
  DisjointSets joined(runs.size());
  const auto join = [&joined](std::size_t a, std::size_t b)
  { joined.Join(static_cast<int>(a), static_cast<int>(b)); };
  RunRange layer = RunsUpTo(runs, 0, numbers.Of(0, 0, begin + 1));
  for (int k = begin; k < end; ++k)
  {
    const RunRange next = RunsUpTo(runs, layer.End, numbers.Of(0, 0, k + 2));
    VisitOverlaps(runs, layer, runs, layer, numbers.Stride(1), join);
    VisitOverlaps(runs, layer, runs, next, numbers.Stride(2), join);
    layer = next;
  }
  std::vector<char> isOpen(runs.size(), 0);          // By root: may go on elsewhere.
  std::vector<std::int64_t> voxels(runs.size(), 0); // By root.
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    voxels[root] += runs[i].Length;
    isOpen[root] |= IsAtBorder(runs[i], own, size);
  }
  std::vector<SetPiece> parts;
  std::vector<int> number(runs.size(), VoxelRun::NoPart); // By root, the first run of its part.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    if (isOpen[root] || voxels[root] >= minimumSize)
    {
      if (number[root] == VoxelRun::NoPart)
      {
        number[root] = static_cast<int>(parts.size());
        parts.push_back({ runs[i].First, voxels[root] });
      }
      runs[kept++] = { runs[i].First, runs[i].Length, number[root] };
    }
  }
  runs.resize(kept);
  runs.shrink_to_fit();
  return parts;
}

/** Pairs of parts that go on from one slab, or one rank's rows, to others. @param runs sorted here */
std::vector<std::pair<int, int>> FindJoins(
  std::vector<VoxelRun>& runs, const std::array<int, 3>& size)
{
  std::vector<std::pair<int, int>> joins;
  std::sort(runs.begin(), runs.end(),
    [](const VoxelRun& a, const VoxelRun& b) { return a.First < b.First; });
  const VoxelNumbers numbers(size);
  const RunRange all = { 0, runs.size() };
  for (const int axis : { 1, 2 })
  {
    VisitOverlaps(runs, all, runs, all, numbers.Stride(axis),
      [&](std::size_t i, std::size_t j)
      {
        // Beyond the last row of a layer lies the first one of the next.
        if (axis == 2 || numbers.PlaceOf(runs[i].First)[1] + 1 < size[1])
        {
          joins.emplace_back(runs[i].Part, runs[j].Part);
        }
      });
  }
  return joins;
}
}

LostVoxels::LostVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressQuestion& goOn, const RankRows* rows)
  : Size(field.Image().Size)
{
  const RankRows own = rows ? *rows : RankRows{ OnThisRank(), VoxelBox::Of(this->Size) };
  PartsOfSlabs parts = this->Search(state, field, kind, minimumSize, executor, goOn, own);
  this->Stopped = own.Ranks.IsAny(this->Stopped);
  if (this->Stopped)
  {
    this->Runs.clear();
    return;
  }
  this->JoinParts(parts, minimumSize, own, executor);
}

LostVoxels::PartsOfSlabs LostVoxels::Search(const SurfaceState& state, const Field& field,
  PartKind kind, std::int64_t minimumSize, Executor& executor, const ProgressQuestion& goOn,
  const RankRows& own)
{
  const VoxelBox& rows = own.Rows;
  PartsOfSlabs parts;
  if (rows.IsEmpty())
  {
    return parts;
  }
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  const int firstSlab = rows.First[2] / LayersOfSlab;
  const auto slabs = static_cast<std::size_t>(
    (rows.End[2] + LayersOfSlab - 1) / LayersOfSlab - firstSlab);
  this->Runs.resize(slabs);
  parts.resize(slabs);
  for (std::size_t first = 0; first < slabs && !this->Stopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForSpans(executor, count, 1,
      [&](std::size_t place, std::size_t, std::size_t)
      {
        const std::size_t slab = firstSlab + first + place; // Of the image.
        const int begin = static_cast<int>(slab) * LayersOfSlab;
        VoxelBox ofSlab = rows;
        ofSlab.First[2] = std::max(begin, rows.First[2]);
        ofSlab.End[2] = std::min(begin + LayersOfSlab, rows.End[2]);
        SlabSearch search(state, field, kind, ofSlab);
        search.LeaveSide(vertices.Begin(slab), vertices.Count(slab));
        for (std::size_t i = 0; i < vertices.Count(slab); ++i)
        {
          search.CloseNear(vertices.Begin(slab)[i]);
        }
        this->Runs[first + place] = search.FindRuns();
        parts[first + place] = NumberParts(this->Runs[first + place], this->Size,
          ofSlab.First[2], ofSlab.End[2], own, minimumSize);
      });
    this->Stopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  return parts;
}

void LostVoxels::JoinParts(PartsOfSlabs& parts, std::int64_t minimumSize,
  const RankRows& own, Executor& executor)
{
  // The parts of all slabs, one after the other, and of all ranks, are joined by rank 0.
  std::vector<std::size_t> first(1, 0);
  std::vector<VoxelRun> border;
  for (std::size_t slab = 0; slab < parts.size(); ++slab)
  {
    for (VoxelRun run : this->Runs[slab])
    {
      run.Part += static_cast<int>(first.back());
      if (IsAtBorder(run, own, this->Size))
      {
        border.push_back(run);
      }
    }
    first.push_back(first.back() + parts[slab].size());
  }
  MessageWriter writer;
  writer.AddArray(Joined(executor, parts));
  writer.AddArray(border);
  const std::vector<Message> ofRanks = own.Ranks.Gather(writer.Take());
  const Message answer = own.Ranks.Scatter(this->JoinRanks(ofRanks, minimumSize));
  MessageReader reader(answer);
  this->Parts = reader.Take<int>();
  const std::vector<int> number = reader.TakeVector<int>();
  ForSpans(executor, this->Runs.size(), 1,
    [&](std::size_t slab, std::size_t, std::size_t)
    {
      std::vector<VoxelRun>& runs = this->Runs[slab];
      for (VoxelRun& run : runs)
      {
        run.Part = number[first[slab] + static_cast<std::size_t>(run.Part)];
      }
      runs.erase(std::remove_if(runs.begin(), runs.end(),
                   [](const VoxelRun& run) { return run.Part == VoxelRun::NoPart; }),
        runs.end());
    });
}

std::vector<Message> LostVoxels::JoinRanks(
  const std::vector<Message>& ofRanks, std::int64_t minimumSize) const
{
  std::vector<SetPiece> pieces; // Of all ranks, one after the other.
  std::vector<VoxelRun> border;
  std::vector<std::size_t> first(1, 0);
  for (const Message& message : ofRanks)
  {
    MessageReader reader(message);
    const std::vector<SetPiece> ofRank = reader.TakeVector<SetPiece>();
    for (VoxelRun run : reader.TakeVector<VoxelRun>())
    {
      run.Part += static_cast<int>(first.back());
      border.push_back(run);
    }
    pieces.insert(pieces.end(), ofRank.begin(), ofRank.end());
    first.push_back(pieces.size());
  }
  const JoinedSets joined = JoinLabels(pieces, FindJoins(border, this->Size), minimumSize);
  std::vector<Message> answers;
  for (std::size_t rank = 0; rank < ofRanks.size(); ++rank)
  {
    MessageWriter writer;
    writer.Add(static_cast<int>(joined.Labels.size()));
    writer.AddArray(std::vector<int>(
      joined.LabelOf.begin() + static_cast<std::ptrdiff_t>(first[rank]),
      joined.LabelOf.begin() + static_cast<std::ptrdiff_t>(first[rank + 1])));
    answers.push_back(writer.Take());
  }
  return answers;
}
}

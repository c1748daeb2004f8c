// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostVoxels.h"

#include "Core/Common/Blocks.h"
#include "Core/Common/DisjointSets.h"
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
/** Slabs between two calls of the checkpoint. */
constexpr std::size_t SlabsPerBatch = 32;
constexpr int NoPart = VoxelRun::NoPart;

/** Whether a run's rank has it beside another rank's rows. */
bool IsAtBorder(const VoxelRun& run, const RankRows& part, const std::array<int, 3>& size)
{
  const std::array<int, 3> place = VoxelNumbers(size).PlaceOf(run.First);
  return part.IsAtBorder(place[1], place[2], size);
}

/**
 * Numbers the parts of the layers [begin, end), in the order of their first voxels, and leaves out
 * those that are too small and end within them. @return the sizes of the others.
 */
std::vector<std::int64_t> NumberParts(std::vector<VoxelRun>& runs, const std::array<int, 3>& size,
  int begin, int end, const RankRows* part, std::int64_t minimumSize)
{
  const VoxelNumbers numbers(size);
  DisjointSets joined(runs.size());
  const auto join = [&joined](std::size_t a, std::size_t b)
  { joined.Join(static_cast<int>(a), static_cast<int>(b)); };
  std::vector<char> isOpen(runs.size(), 0); // By root: may go on in another slab.
  RunRange layer = RunsUpTo(runs, 0, numbers.Of(0, 0, begin + 1));
  for (int k = begin; k < end; ++k)
  {
    const RunRange next = RunsUpTo(runs, layer.End, numbers.Of(0, 0, k + 2));
    VisitOverlaps(runs, layer, runs, layer, numbers.Stride(1), join);
    VisitOverlaps(runs, layer, runs, next, numbers.Stride(2), join);
    if ((k == begin && begin > 0) || (k + 1 == end && end < size[2]))
    {
      std::fill(isOpen.begin() + static_cast<std::ptrdiff_t>(layer.Begin),
        isOpen.begin() + static_cast<std::ptrdiff_t>(layer.End), 1);
    }
    layer = next;
  }
  std::vector<std::int64_t> voxels(runs.size(), 0); // By root.
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    voxels[root] += runs[i].Length;
    isOpen[root] |= isOpen[i] || (part && IsAtBorder(runs[i], *part, size));
  }
  std::vector<std::int64_t> sizes;
  std::vector<int> number(runs.size(), NoPart); // By root, the first run of its part.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    if (isOpen[root] || voxels[root] >= minimumSize)
    {
      if (number[root] == NoPart)
      {
        number[root] = static_cast<int>(sizes.size());
        sizes.push_back(voxels[root]);
      }
      runs[kept++] = { runs[i].First, runs[i].Length, number[root] };
    }
  }
  runs.resize(kept);
  runs.shrink_to_fit();
  return sizes;
}
}

LostVoxels::LostVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const Checkpoint& goOn, const RankRows* part)
  : Size(field.Image().Size)
{
  SizesOfSlabs sizes = this->Search(state, field, kind, minimumSize, executor, goOn, part);
  this->Stopped = part ? part->Ranks.IsAny(this->Stopped) : this->Stopped;
  if (this->Stopped)
  {
    this->Runs.clear();
    return;
  }
  this->JoinSlabs(sizes, minimumSize, executor, part);
  if (part)
  {
    this->JoinRanks(minimumSize, *part);
  }
}

LostVoxels::SizesOfSlabs LostVoxels::Search(const SurfaceState& state, const Field& field,
  PartKind kind, std::int64_t minimumSize, Executor& executor, const Checkpoint& goOn,
  const RankRows* part)
{
  const VoxelBox rows = part ? part->Rows : VoxelBox::Of(this->Size);
  SizesOfSlabs sizes;
  if (rows.IsEmpty())
  {
    return sizes;
  }
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  this->FirstSlab = rows.First[2] / LayersOfSlab;
  const auto slabs = static_cast<std::size_t>(
    (rows.End[2] + LayersOfSlab - 1) / LayersOfSlab - this->FirstSlab);
  this->Runs.resize(slabs);
  sizes.resize(slabs);
  for (std::size_t first = 0; first < slabs && !this->Stopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForBlocks(executor, count, 1,
      [&](std::size_t place, std::size_t, std::size_t)
      {
        const std::size_t slab = this->FirstSlab + first + place; // Of the image.
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
        sizes[first + place] = NumberParts(this->Runs[first + place], this->Size,
          ofSlab.First[2], ofSlab.End[2], part, minimumSize);
      });
    this->Stopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  return sizes;
}

void LostVoxels::JoinSlabs(
  SizesOfSlabs& sizes, std::int64_t minimumSize, Executor& executor, const RankRows* part)
{
  const std::int64_t layer = VoxelNumbers(this->Size).Stride(2);
  const std::size_t slabs = this->Runs.size();
  // The parts of all slabs, in the order of their first voxels.
  const std::vector<std::size_t> first = FirstOfBlocks(
    executor, slabs, 1, [&sizes](std::size_t slab, std::size_t) { return sizes[slab].size(); });
  const auto numberOf = [&first](std::size_t slab, int part)
  { return static_cast<int>(first[slab]) + part; };
  std::vector<std::vector<std::pair<int, int>>> borders(slabs);
  ForBlocks(executor, slabs, 1,
    [&](std::size_t slab, std::size_t, std::size_t)
    {
      if (slab == 0 || this->Runs[slab].empty())
      {
        return;
      }
      const std::vector<VoxelRun>& before = this->Runs[slab - 1];
      const std::vector<VoxelRun>& after = this->Runs[slab];
      const std::int64_t begin =
        (this->FirstSlab + static_cast<std::int64_t>(slab)) * LayersOfSlab * layer;
      const std::size_t last = RunsUpTo(before, 0, begin - layer).End;
      VisitOverlaps(before, { last, before.size() }, after, RunsUpTo(after, 0, begin + layer),
        layer,
        [&](std::size_t i, std::size_t j)
        {
          borders[slab].emplace_back(
            numberOf(slab - 1, before[i].Part), numberOf(slab, after[j].Part));
        });
    });
  const std::vector<std::int64_t> sizeOf = Joined(executor, sizes);
  DisjointSets joined(sizeOf.size());
  for (const auto& border : borders)
  {
    for (const std::pair<int, int>& pair : border)
    {
      joined.Join(pair.first, pair.second);
    }
  }
  std::vector<std::int64_t> whole(sizeOf.size(), 0);
  for (std::size_t i = 0; i < sizeOf.size(); ++i)
  {
    whole[joined.Find(static_cast<int>(i))] += sizeOf[i];
  }
  std::vector<char> mayGoOn(sizeOf.size(), 0); // On another rank.
  for (std::size_t slab = 0; part && slab < slabs; ++slab)
  {
    for (const VoxelRun& run : this->Runs[slab])
    {
      mayGoOn[joined.Find(numberOf(slab, run.Part))] |= IsAtBorder(run, *part, this->Size);
    }
  }
  std::vector<int> number(sizeOf.size(), NoPart);
  for (std::size_t i = 0; i < sizeOf.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    if (whole[root] >= minimumSize || mayGoOn[root])
    {
      // A root is the first of its parts.
      number[i] = root == static_cast<int>(i) ? this->Parts++ : number[root];
    }
  }
  ForBlocks(executor, slabs, 1,
    [&](std::size_t slab, std::size_t, std::size_t)
    {
      std::vector<VoxelRun>& runs = this->Runs[slab];
      for (VoxelRun& run : runs)
      {
        run.Part = number[numberOf(slab, run.Part)];
      }
      runs.erase(std::remove_if(runs.begin(), runs.end(),
                   [](const VoxelRun& run) { return run.Part == NoPart; }),
        runs.end());
    });
}
}

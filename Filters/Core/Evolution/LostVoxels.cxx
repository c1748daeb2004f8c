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

/** Places of runs that follow each other in a list. */
struct Range
{
  std::size_t Begin;
  std::size_t End;
};

/** Those of the runs that begin before a voxel, from a place on. */
Range RangeUpTo(const std::vector<VoxelRun>& runs, std::size_t begin, std::int64_t voxel)
{
  const auto end = std::partition_point(runs.begin() + static_cast<std::ptrdiff_t>(begin),
    runs.end(), [voxel](const VoxelRun& run) { return run.First < voxel; });
  return { begin, static_cast<std::size_t>(end - runs.begin()) };
}

/** Calls visit(place in a, place in b) where a run, `shift` voxels further, overlaps another. */
template <typename Visit>
void VisitOverlaps(const std::vector<VoxelRun>& a, Range inA, const std::vector<VoxelRun>& b,
  Range inB, std::int64_t shift, const Visit& visit)
{
  std::size_t i = inA.Begin;
  std::size_t j = inB.Begin;
  while (i < inA.End && j < inB.End)
  {
    const std::int64_t first = a[i].First + shift;
    const std::int64_t end = first + a[i].Length;
    const std::int64_t otherEnd = b[j].First + b[j].Length;
    if (first < otherEnd && b[j].First < end)
    {
      visit(i, j);
    }
    (end < otherEnd ? i : j) += 1;
  }
}

/**
 * Numbers the parts of the layers [begin, end), in the order of their first voxels, and leaves out
 * those that are too small and end within them. @return the sizes of the others.
 */
std::vector<std::int64_t> NumberParts(std::vector<VoxelRun>& runs, const VoxelNumbers& numbers,
  int begin, int end, bool isFirst, bool isLast, std::int64_t minimumSize)
{
  DisjointSets joined(runs.size());
  const auto join = [&joined](std::size_t a, std::size_t b)
  { joined.Join(static_cast<int>(a), static_cast<int>(b)); };
  std::vector<char> isOpen(runs.size(), 0); // By root: may go on in another slab.
  Range layer = RangeUpTo(runs, 0, numbers.Of(0, 0, begin + 1));
  for (int k = begin; k < end; ++k)
  {
    const Range next = RangeUpTo(runs, layer.End, numbers.Of(0, 0, k + 2));
    VisitOverlaps(runs, layer, runs, layer, numbers.Stride(1), join);
    VisitOverlaps(runs, layer, runs, next, numbers.Stride(2), join);
    if ((k == begin && !isFirst) || (k + 1 == end && !isLast))
    {
      std::fill(isOpen.begin() + static_cast<std::ptrdiff_t>(layer.Begin),
        isOpen.begin() + static_cast<std::ptrdiff_t>(layer.End), 1);
    }
    layer = next;
  }
  std::vector<std::int64_t> size(runs.size(), 0); // By root.
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    size[root] += runs[i].Length;
    isOpen[root] |= isOpen[i];
  }
  std::vector<std::int64_t> sizes;
  std::vector<int> number(runs.size(), NoPart); // By root, the first run of its part.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    if (isOpen[root] || size[root] >= minimumSize)
    {
      if (number[root] == NoPart)
      {
        number[root] = static_cast<int>(sizes.size());
        sizes.push_back(size[root]);
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
  int minimumSize, Executor& executor, const Checkpoint& goOn)
{
  const std::array<int, 3>& size = field.Image().Size;
  const VoxelNumbers numbers(size);
  const auto slabs = static_cast<std::size_t>((size[2] + LayersOfSlab - 1) / LayersOfSlab);
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  this->Runs.resize(slabs);
  std::vector<std::vector<std::int64_t>> sizes(slabs);
  for (std::size_t first = 0; first < slabs && !this->Stopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForBlocks(executor, count, 1,
      [&](std::size_t place, std::size_t, std::size_t)
      {
        const std::size_t slab = first + place;
        const int begin = static_cast<int>(slab) * LayersOfSlab;
        const int end = std::min(begin + LayersOfSlab, size[2]);
        SlabSearch search(state, field, kind, begin, end);
        search.LeaveSide(vertices.Begin(slab), vertices.Count(slab));
        for (std::size_t i = 0; i < vertices.Count(slab); ++i)
        {
          search.CloseNear(vertices.Begin(slab)[i]);
        }
        this->Runs[slab] = search.FindRuns();
        sizes[slab] = NumberParts(this->Runs[slab], numbers, begin, end, slab == 0,
          slab + 1 == slabs, minimumSize);
      });
    this->Stopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  if (this->Stopped)
  {
    this->Runs.clear();
    return;
  }
  this->JoinSlabs(sizes, numbers.Stride(2), minimumSize, executor);
}

void LostVoxels::JoinSlabs(std::vector<std::vector<std::int64_t>>& sizes, std::int64_t layer,
  std::int64_t minimumSize, Executor& executor)
{
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
      const std::int64_t begin = static_cast<std::int64_t>(slab) * LayersOfSlab * layer;
      const std::size_t last = RangeUpTo(before, 0, begin - layer).End;
      VisitOverlaps(before, { last, before.size() }, after, RangeUpTo(after, 0, begin + layer),
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
  for (std::size_t part = 0; part < sizeOf.size(); ++part)
  {
    whole[joined.Find(static_cast<int>(part))] += sizeOf[part];
  }
  std::vector<int> number(sizeOf.size(), NoPart);
  for (std::size_t part = 0; part < sizeOf.size(); ++part)
  {
    const int root = joined.Find(static_cast<int>(part));
    if (whole[root] >= minimumSize)
    {
      // A root is the first of its parts.
      number[part] = root == static_cast<int>(part) ? this->Parts++ : number[root];
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

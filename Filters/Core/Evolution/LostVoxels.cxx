// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostVoxels.h"

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

/** Whether a run lies beside another slab. */
bool IsAtBorder(const VoxelRun& run, const std::array<int, 3>& size)
{
  const int k = VoxelNumbers(size).PlaceOf(run.First)[2];
  return (k % LayersOfSlab == 0 && k > 0) ||
    (k % LayersOfSlab == LayersOfSlab - 1 && k + 1 < size[2]);
}

/**
 * Numbers the parts of the layers [begin, end), in the order of their first voxels, and leaves out
 * those that are too small and end within them. @return the others
 */
std::vector<SetPiece> NumberParts(std::vector<VoxelRun>& runs, const std::array<int, 3>& size,
  int begin, int end, std::int64_t minimumSize)
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
    isOpen[root] |= IsAtBorder(runs[i], size);
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

/** Pairs of parts that go on from one slab to others. @param runs sorted here */
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
  int minimumSize, Executor& executor, const ProgressQuestion& goOn)
  : Size(field.Image().Size)
{
  PartsOfSlabs parts = this->Search(state, field, kind, minimumSize, executor, goOn);
  if (this->Stopped)
  {
    this->Runs.clear();
    return;
  }
  this->JoinParts(parts, minimumSize, executor);
}

LostVoxels::PartsOfSlabs LostVoxels::Search(const SurfaceState& state, const Field& field,
  PartKind kind, std::int64_t minimumSize, Executor& executor, const ProgressQuestion& goOn)
{
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  const auto slabs = static_cast<std::size_t>((this->Size[2] + LayersOfSlab - 1) / LayersOfSlab);
  PartsOfSlabs parts(slabs);
  this->Runs.resize(slabs);
  for (std::size_t first = 0; first < slabs && !this->Stopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForSpans(executor, count, 1,
      [&](std::size_t place, std::size_t, std::size_t)
      {
        const std::size_t slab = first + place;
        const int begin = static_cast<int>(slab) * LayersOfSlab;
        const int end = std::min(begin + LayersOfSlab, this->Size[2]);
        SlabSearch search(state, field, kind, begin, end);
        search.LeaveSide(vertices.Begin(slab), vertices.Count(slab));
        for (std::size_t i = 0; i < vertices.Count(slab); ++i)
        {
          search.CloseNear(vertices.Begin(slab)[i]);
        }
        this->Runs[slab] = search.FindRuns();
        parts[slab] = NumberParts(this->Runs[slab], this->Size, begin, end, minimumSize);
      });
    this->Stopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  return parts;
}

void LostVoxels::JoinParts(PartsOfSlabs& parts, std::int64_t minimumSize, Executor& executor)
{
  // The parts of all slabs, one after the other.
  std::vector<std::size_t> first(1, 0);
  std::vector<VoxelRun> border;
  for (std::size_t slab = 0; slab < parts.size(); ++slab)
  {
    for (VoxelRun run : this->Runs[slab])
    {
      run.Part += static_cast<int>(first.back());
      if (IsAtBorder(run, this->Size))
      {
        border.push_back(run);
      }
    }
    first.push_back(first.back() + parts[slab].size());
  }
  const JoinedSets joined =
    JoinLabels(Joined(executor, parts), FindJoins(border, this->Size), minimumSize);
  this->Parts = static_cast<int>(joined.Labels.size());
  ForSpans(executor, this->Runs.size(), 1,
    [&](std::size_t slab, std::size_t, std::size_t)
    {
      std::vector<VoxelRun>& runs = this->Runs[slab];
      for (VoxelRun& run : runs)
      {
        run.Part = joined.LabelOf[first[slab] + static_cast<std::size_t>(run.Part)];
      }
      runs.erase(std::remove_if(runs.begin(), runs.end(),
                   [](const VoxelRun& run) { return run.Part == VoxelRun::NoPart; }),
        runs.end());
    });
}
}

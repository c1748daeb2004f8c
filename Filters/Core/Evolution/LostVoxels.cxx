// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/LostVoxels.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Common/Spans.h"
#include "Core/Evolution/VerticesOfSlabs.h"
#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
/** Layers of a slab. */
constexpr int LayersOfSlab = 8;
/** Slabs between two questions whether to go on. */
constexpr std::size_t SlabsPerBatch = 32;

/** Whether a run lies beside another slab. */
bool IsAtBorder(const VoxelRun& run, const std::array<int, 3>& size)
{
  const int k = VoxelNumbers(size).PlaceOf(run.First)[2];
  return (k % LayersOfSlab == 0 && k > 0) ||
    (k % LayersOfSlab == LayersOfSlab - 1 && k + 1 < size[2]);
}

/** Joins runs, which are in order, that lie beside each other. */
void JoinRuns(
  const std::vector<VoxelRun>& runs, const std::array<int, 3>& size, DisjointSets& joined)
{
  const VoxelNumbers numbers(size);
  for (const int axis : { 1, 2 })
  {
    const std::int64_t shift = numbers.Stride(axis);
    for (std::size_t i = 0, j = 0; j < runs.size();)
    {
      const std::int64_t first = runs[i].First + shift;
      const std::int64_t end = first + runs[i].Length;
      const std::int64_t otherEnd = runs[j].First + runs[j].Length;
      // Beyond the last row of a layer lies the first one of the next.
      if (first < otherEnd && runs[j].First < end &&
        (axis == 2 || numbers.PlaceOf(runs[i].First)[1] + 1 < size[1]))
      {
        joined.Join(static_cast<int>(i), static_cast<int>(j));
      }
      (end < otherEnd ? i : j) += 1;
    }
  }
}

/**
 * Numbers the parts of runs, which are in order, by their first voxels, and leaves out those that
 * are too small. @param isOpen of a run whose part may go on elsewhere @return how many there are
 */
template <typename IsOpen>
int NumberParts(std::vector<VoxelRun>& runs, const std::array<int, 3>& size,
  std::int64_t minimumSize, const IsOpen& isOpen)
{
  DisjointSets joined(runs.size());
  JoinRuns(runs, size, joined);
  std::vector<std::int64_t> voxels(runs.size(), 0); // By root, the first run of its part.
  std::vector<char> stays(runs.size(), 0);          // Likewise.
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const int root = joined.Find(static_cast<int>(i));
    voxels[root] += runs[i].Length;
    stays[root] |= isOpen(runs[i]) || voxels[root] >= minimumSize;
  }
  int parts = 0;
  std::vector<int> number(runs.size(), 0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const auto root = static_cast<std::size_t>(joined.Find(static_cast<int>(i)));
    if (stays[root])
    {
      number[i] = root == i ? parts++ : number[root];
      runs[kept++] = { runs[i].First, runs[i].Length, number[i] };
    }
  }
  runs.resize(kept);
  runs.shrink_to_fit();
  return parts;
}
}

LostVoxels FindLostVoxels(const SurfaceState& state, const Field& field, PartKind kind,
  int minimumSize, Executor& executor, const ProgressQuestion& goOn)
{
  const std::array<int, 3>& size = field.Image().Size;
  const VerticesOfSlabs vertices(
    state.Mesh, field.Image(), LayersOfSlab, NearUnits * field.Image().Unit, executor);
  const auto slabs = static_cast<std::size_t>((size[2] + LayersOfSlab - 1) / LayersOfSlab);
  std::vector<std::vector<VoxelRun>> runs(slabs);
  LostVoxels lost;
  for (std::size_t first = 0; first < slabs && !lost.IsStopped; first += SlabsPerBatch)
  {
    const std::size_t count = std::min(SlabsPerBatch, slabs - first);
    ForSpans(executor, count, 1,
      [&](std::size_t place, std::size_t, std::size_t)
      {
        const std::size_t slab = first + place;
        const int begin = static_cast<int>(slab) * LayersOfSlab;
        SlabSearch search(state, field, kind, begin, std::min(begin + LayersOfSlab, size[2]));
        search.LeaveSide(vertices.Begin(slab), vertices.Count(slab));
        for (std::size_t i = 0; i < vertices.Count(slab); ++i)
        {
          search.CloseNear(vertices.Begin(slab)[i]);
        }
        runs[slab] = search.FindRuns();
        NumberParts(runs[slab], size, minimumSize,
          [&size](const VoxelRun& run) { return IsAtBorder(run, size); });
      });
    lost.IsStopped = !goOn(static_cast<double>(first + count) / static_cast<double>(slabs));
  }
  if (!lost.IsStopped)
  {
    lost.Runs = Joined(executor, runs);
    lost.Parts = NumberParts(lost.Runs, size, minimumSize, [](const VoxelRun&) { return false; });
  }
  return lost;
}
}

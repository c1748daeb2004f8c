// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelRuns_h
#define volumicVoxelRuns_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Voxels of a part that follow each other along x. */
struct VoxelRun
{
  static constexpr int NoPart = -1;

  std::int64_t First; ///< Number of the first one, see VoxelNumbers.
  int Length;
  int Part = NoPart;
};

/** Places of runs that follow each other in a list. */
struct RunRange
{
  std::size_t Begin;
  std::size_t End;
};

/** Those of the runs, which are in order, that begin before a voxel, from a place on. */
inline RunRange RunsUpTo(const std::vector<VoxelRun>& runs, std::size_t begin, std::int64_t voxel)
{
  const auto end = std::partition_point(runs.begin() + static_cast<std::ptrdiff_t>(begin),
    runs.end(), [voxel](const VoxelRun& run) { return run.First < voxel; });
  return { begin, static_cast<std::size_t>(end - runs.begin()) };
}

/** Calls visit(place in a, place in b) where a run, `shift` voxels further, overlaps another. */
template <typename Visit>
void VisitOverlaps(const std::vector<VoxelRun>& a, RunRange inA, const std::vector<VoxelRun>& b,
  RunRange inB, std::int64_t shift, const Visit& visit)
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
}

#endif

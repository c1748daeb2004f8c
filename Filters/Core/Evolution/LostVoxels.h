// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLostVoxels_h
#define volumicLostVoxels_h

#include "Core/Common/Executor.h"
#include "Core/Common/JoinLabels.h"
#include "Core/Common/Monitor.h"
#include "Core/Evolution/SlabSearch.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The voxels that a surface has lost: those on the object's side outside of it, or on the other
 * side inside of it, that are farther than NearUnits from any vertex. They are kept as runs; where
 * nothing is lost there is nothing to keep.
 *
 * Voxels that share a face are of one part. The image is searched in slabs of layers, each on its
 * own: inside is found by parity along rows, so the cost is O(voxels + triangles).
 */
class LostVoxels
{
public:
  /**
   * The state's edges must not be longer than its sizing allows.
   * @param minimumSize voxels; what has fewer is left out
   * @param goOn        told the share that is done now and then; once it says no nothing is found
   */
  LostVoxels(const SurfaceState& state, const Field& field, PartKind kind, int minimumSize,
    Executor& executor, const ProgressQuestion& goOn);

  /** Whether it was told to stop: then nothing is found. */
  bool IsStopped() const { return this->Stopped; }
  /** Parts of the image are numbered from 0 in the order of their first voxels. */
  int NumberOfParts() const { return this->Parts; }
  /** The runs of each slab, by number. */
  const std::vector<std::vector<VoxelRun>>& Slabs() const { return this->Runs; }

private:
  using PartsOfSlabs = std::vector<std::vector<SetPiece>>;

  PartsOfSlabs Search(const SurfaceState& state, const Field& field, PartKind kind,
    std::int64_t minimumSize, Executor& executor, const ProgressQuestion& goOn);
  /** Joins what the slabs have found, each for itself, to parts of the image. */
  void JoinParts(PartsOfSlabs& parts, std::int64_t minimumSize, Executor& executor);

  std::array<int, 3> Size = { 0, 0, 0 }; ///< Of the image.
  std::vector<std::vector<VoxelRun>> Runs;
  int Parts = 0;
  bool Stopped = false;
};
}

#endif

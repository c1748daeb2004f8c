// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSlabSearch_h
#define volumicSlabSearch_h

#include "Core/Image/Field.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Surface/SurfaceState.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Voxels within this distance of a vertex are not missed, in units of the level. */
constexpr double NearUnits = 2.;

/** Consecutive voxels of a part along x. */
struct VoxelRun
{
  std::int64_t First; ///< linear index of the first voxel, see VoxelNumbers
  int Length;
  int Part;
};

/** Kind of missed parts. */
enum class PartKind
{
  Object, ///< object outside the surface
  Cavity  ///< background inside the surface
};

/**
 * Search of one slab, a range of slices of an image, for missed voxels (see MissedVoxels).
 */
class SlabSearch
{
public:
  /** Search the slices [begin, end). The arguments must outlive the object. */
  SlabSearch(const SurfaceState& state, const Field& field, PartKind kind, int begin, int end);

  /**
   * Select the voxels outside the surface (for cavities: inside).
   * @param vertices all vertices of faces that cross the slab
   */
  void LeaveSide(const int* vertices, std::size_t count);
  /** Deselect the voxels within NearUnits of a vertex. */
  void CloseNear(int v);
  /** Return the selected voxels of the object (for cavities: background), in order. */
  std::vector<VoxelRun> FindRuns() const;

private:
  /** Append the runs of a row, given its first voxel, bits and values. */
  void AddRuns(std::int64_t row, const std::uint64_t* open, const std::vector<float>& values,
    std::vector<VoxelRun>& runs) const;
  /** Select or deselect the voxels [first, last] of a row. */
  void Set(std::int64_t row, int first, int last, bool isOpen);

  const SurfaceState& State;
  const Field& TheField;
  PartKind Kind;
  std::array<int, 3> Size;
  RowGrid Rows;
  int Words; ///< words of bits per row
  double Inverse[3];
  std::vector<std::uint64_t> Open; ///< selection: a bit per voxel, row by row
};
}

#endif

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
/** A voxel that lies no farther than so many units of the level from a vertex is not lost. */
constexpr double NearUnits = 2.;

/** Voxels of a part that follow each other along x. */
struct VoxelRun
{
  std::int64_t First; ///< Number of the first one, see VoxelNumbers.
  int Length;
  int Part;
};

/** Which kind of parts a surface may have lost. */
enum class PartKind
{
  Object, ///< Object outside the surface.
  Cavity  ///< Background inside the surface.
};

/**
 * The search of one slab, a range of layers of an image, for the voxels that a surface has lost:
 * see MissedVoxels.
 */
class SlabSearch
{
public:
  /** Searches the layers [begin, end). What is given must outlive it. */
  SlabSearch(const SurfaceState& state, const Field& field, PartKind kind, int begin, int end);

  /**
   * Leaves the voxels open that lie outside the surface (for cavities: inside). `vertices`: all of
   * whose faces one may cross a layer.
   */
  void LeaveSide(const int* vertices, std::size_t count);
  /** Closes the voxels that are no farther than NearUnits from a vertex. */
  void CloseNear(int v);
  /** The voxels that are open and of the kind that is looked for, by number. */
  std::vector<VoxelRun> FindRuns() const;

private:
  /** Those of a row: number of its first voxel, bits and values. */
  void AddRuns(std::int64_t row, const std::uint64_t* open, const std::vector<float>& values,
    std::vector<VoxelRun>& runs) const;
  /** Opens or closes voxels of a row of the slab, the last one as well. */
  void Set(std::int64_t row, int first, int last, bool isOpen);

  const SurfaceState& State;
  const Field& TheField;
  PartKind Kind;
  std::array<int, 3> Size;
  RowGrid Rows;
  int Words; ///< How many words of bits a row has.
  double Inverse[3];
  std::vector<std::uint64_t> Open; ///< A bit for each voxel that may be lost, row by row.
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMissedBoundary_h
#define volumicMissedBoundary_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/MissedVoxels.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Boundary of the missed parts, kept from their detection, to measure later how much of it the
 * surface still misses. The cost depends on the number of missed voxels only.
 */
class MissedBoundary
{
public:
  /** Add the boundary of missed parts: the voxel faces between object and background. */
  void Add(const MissedVoxels& missed, const Field& field, PartKind kind, Executor& executor);
  void Add(const MissedBoundary& other);

  struct Missing
  {
    int Parts = 0;     ///< parts with more than half of their boundary missed
    double Share = 0.; ///< missed area, relative to the sum of missed and surface area
  };
  /** Measure the boundary without a vertex of the surface within NearUnits. */
  Missing MissedBy(
    const SurfaceState& state, double surfaceArea, const Field& field, Executor& executor) const;
  /** Return the voxels with faces of the boundary. */
  std::vector<std::int64_t> Voxels() const;

private:
  struct Patch
  {
    std::int64_t Voxel;
    float Area;
    int Part;
  };
  /** Return for each patch whether a vertex is near. */
  std::vector<std::uint8_t> AreNear(
    const SurfaceState& state, const Field& field, Executor& executor) const;

  std::vector<Patch> Patches;
  int Parts = 0;
};
}

#endif

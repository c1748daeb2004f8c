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
 * The boundary of the parts that a surface has lost, kept from when they were found, so that it can
 * be told later what of it the surface still misses. Voxels that were not lost cost nothing.
 */
class MissedBoundary
{
public:
  /** Takes the boundary of lost parts: the faces of their voxels towards the other side. */
  void Add(const MissedVoxels& missed, const Field& field, PartKind kind, Executor& executor);
  void Add(const MissedBoundary& other);

  struct Missing
  {
    int Parts = 0;     ///< Those of which the surface misses more than half of the boundary.
    double Share = 0.; ///< Area of all the boundary that is missed, over that and the surface's.
  };
  /** Finds what has no vertex of the surface, of this area, within NearUnits. Areas: workspace. */
  Missing MissedBy(
    const SurfaceState& state, double surfaceArea, const Field& field, Executor& executor) const;
  /** Those that have faces of the boundary. */
  std::vector<std::int64_t> Voxels() const;

private:
  struct Patch
  {
    std::int64_t Voxel;
    float Area;
    int Part;
  };
  /** Whether each of the patches has a vertex near. */
  std::vector<std::uint8_t> AreNear(
    const SurfaceState& state, const Field& field, Executor& executor) const;

  std::vector<Patch> Patches;
  int Parts = 0;
};
}

#endif

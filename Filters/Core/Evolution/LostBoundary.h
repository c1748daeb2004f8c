// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLostBoundary_h
#define volumicLostBoundary_h

#include "Core/Common/Communicator.h"
#include "Core/Common/Executor.h"
#include "Core/Evolution/LostVoxels.h"
#include "Core/Image/Field.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/SurfaceState.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * The boundary of the parts that a surface has lost, kept from when they were found, so that it can
 * be told later what of it the surface still misses. Costs nothing for voxels that were not lost.
 */
class LostBoundary
{
public:
  /** Takes the boundary of lost parts: the faces of their voxels towards the other side. */
  void Add(const LostVoxels& lost, const Field& field, PartKind kind, Executor& executor);
  void Add(const LostBoundary& other);
  /** What the ranks have of one kind of parts, each of its own rows, goes to rank 0. */
  void Gather(Communicator& ranks);

  struct Missing
  {
    int Parts = 0; ///< Those of which the surface misses more than half of the boundary.
    double Share = 0.; ///< Area of all the boundary that is missed, over that and the surface's.
  };
  /** What has no vertex of the surface within NearUnits. Areas: workspace. */
  Missing MissedBy(const SurfaceState& state, const Field& field, Executor& executor) const
  {
    return this->MissedBy(AreNear(this->Voxels(), state, field, executor),
      SurfaceArea(state.Mesh, executor));
  }

  /** The same where the surface is on several ranks: rank 0 asks each about its part. */
  std::vector<std::int64_t> Voxels() const;
  /** Whether each of some voxels has a vertex near. */
  static std::vector<std::uint8_t> AreNear(const std::vector<std::int64_t>& voxels,
    const SurfaceState& state, const Field& field, Executor& executor);
  /** @param areNear of Voxels(), on any rank @param surfaceArea of all */
  Missing MissedBy(const std::vector<std::uint8_t>& areNear, double surfaceArea) const;

private:
  struct Patch
  {
    std::int64_t Voxel;
    float Area;
    int Part;
  };
  std::vector<Patch> Patches;
  int Parts = 0;
};
}

#endif

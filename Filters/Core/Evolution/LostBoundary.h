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
 * be told later what of it the surface still misses. Voxels that were not lost cost nothing.
 */
class LostBoundary
{
public:
  /** Takes the boundary of lost parts: the faces of their voxels towards the other side. */
  void Add(const LostVoxels& lost, const Field& field, PartKind kind, Executor& executor);
  void Add(const LostBoundary& other);
  /** By all ranks: what each has found of one kind of parts, in its own rows, goes to rank 0. */
  void Gather(Communicator& ranks);

  struct Missing
  {
    int Parts = 0; ///< Those of which the surface misses more than half of the boundary.
    double Share = 0.; ///< Area of all the boundary that is missed, over that and the surface's.
  };
  /** Finds what has no vertex of the surface within NearUnits. Areas: workspace. */
  Missing MissedBy(const SurfaceState& state, const Field& field, Executor& executor) const
  {
    return this->MissedBy(AreNear(this->Voxels(), state, field, executor),
      SurfaceArea(state.Mesh, executor));
  }

  /** The same where ranks have pieces of the surface: rank 0 asks each about its own. */
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

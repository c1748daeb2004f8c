// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentNesting_h
#define volumicComponentNesting_h

#include "Core/Common/ExactSum.h"
#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/SurfaceMesh.h"

#include <vector>

namespace volumic
{
// Which components are inside out: a cavity must lie inside the others, any other one outside. They
// are judged from outside in, as if what is inside out were not there. Rays along x: O(n + pairs of
// ray and triangle that overlap). Labels are those of all components, from 0.

/** From the first vertex of a component along x. */
struct ComponentRay
{
  int Root;
  int Label;
  Point Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** A ray that another component crosses an odd number of times. */
struct RayCrossing
{
  int Ray; ///< Its place among the rays.
  int Label;
  bool operator<(const RayCrossing& other) const
  {
    return this->Ray != other.Ray ? this->Ray < other.Ray : this->Label < other.Label;
  }
};

/** The sums of what SignedVolume::OfFace says of faces, by label, as `origins` are. */
std::vector<ExactSum> VolumesOfFaces(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<Vector>& origins, Executor& executor);

/** A ray of each component, by Y. @param roots,places,volumes of each label */
std::vector<ComponentRay> CastRays(const std::vector<int>& roots,
  const std::vector<Vector>& places, const std::vector<ExactSum>& volumes);

/** Of the faces with the rays of other components, sorted. */
std::vector<RayCrossing> FindCrossings(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const std::vector<ComponentRay>& rays, Executor& executor);

/** @return the roots of those that are inside out, those within fewer others first */
std::vector<int> JudgeFromOutsideIn(
  const std::vector<ComponentRay>& rays, const std::vector<RayCrossing>& crossings);
}

#endif

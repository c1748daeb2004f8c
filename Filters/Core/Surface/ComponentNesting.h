// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicComponentNesting_h
#define volumicComponentNesting_h

#include "Core/Common/ExactSum.h"
#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/SurfaceMesh.h"
#include "Core/Surface/ConnectedVertices.h"

#include <vector>

namespace volumic
{
// Which components are inside out: a cavity must lie inside the others, any other one outside. They
// are judged from outside in, as if what is inside out were not there. Rays along x: O(n + pairs of
// ray and triangle that overlap). A surface may be in pieces (SurfaceComponents): the faces of a
// piece are those whose smallest vertex is marked. Labels are those of all components, from 0.

/** From the first vertex of a component along x. */
struct ComponentRay
{
  int Root;
  int Label;
  Point Origin;
  bool IsCavity; ///< The component's volume is negative.
};

/** A ray that another component crosses, in the piece an odd number of times. */
struct RayCrossing
{
  int Ray; ///< Its place among the rays.
  int Label;
  bool operator<(const RayCrossing& other) const
  {
    return this->Ray != other.Ray ? this->Ray < other.Ray : this->Label < other.Label;
  }
};

/** The sums of what SignedVolume::OfFace says of the piece's faces. @param origins by label */
std::vector<ExactSum> VolumesOfFaces(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const MarkedVertices& piece, const std::vector<Vector>& origins, Executor& executor);

/** A ray of each component, by Y. @param roots,places,volumes of each label */
std::vector<ComponentRay> CastRays(const std::vector<int>& roots,
  const std::vector<Vector>& places, const std::vector<ExactSum>& volumes);

/** The crossings of the piece's faces with the rays of other components, sorted. */
std::vector<RayCrossing> FindCrossings(const SurfaceMesh& mesh, const LargeVector<int>& labels,
  const MarkedVertices& piece, const std::vector<ComponentRay>& rays, Executor& executor);

/** Of the crossings of several pieces those that there are an odd number of, sorted, each once. */
void KeepOdd(std::vector<RayCrossing>& crossings);

/**
 * @param crossings of all pieces, odd
 * @return the roots of those that are inside out, those within fewer others first
 */
std::vector<int> JudgeFromOutsideIn(
  const std::vector<ComponentRay>& rays, const std::vector<RayCrossing>& crossings);
}

#endif

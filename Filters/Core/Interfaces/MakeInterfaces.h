// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMakeInterfaces_h
#define volumicMakeInterfaces_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <functional>

namespace volumic
{
/** How interfaces are made; lengths: workspace. */
struct InterfaceOptions
{
  double Edge = 1.36; ///< mean length of edges that is wanted, where they are not to be longer
  /** How far voxels may be on the wrong side, in smallest distances of voxels. */
  double VoxelTolerance = 0.;
  /** How far faces may be from the interfaces of the fields; 0: all edges are of one length. */
  double Tolerance = 0.;
  double MostSize = 4.;   ///< With a tolerance, how many times longer edges may become.
  double Gradation = 0.3; ///< With a tolerance, by how much they grow per length at most.

  /** How long edges were at most, in Edge and the size about them: the last step draws some out. */
  static constexpr double LongestInEdge = 2.2;
};

/**
 * The interfaces of all objects of a label map, as one conforming mesh without intersections. Not
 * the paper's: what evolves is no closed surface, and does not change its topology.
 *
 * 1. The start has the topology of the voxels (StartInterfaces).
 * 2. Rounds of edits (InterfaceRemesher) bring its edges to one length, while its vertices go to
 *    where the fields of the objects beside them are the same (MoveInterfaces).
 * 3. Meanwhile fields are shifted so that each object keeps the volume of its voxels, and changed
 * at voxels that triangles cut off, until these are few.
 * 4. With a tolerance the last rounds are others: edges become as long as it allows (AdjustSizes).
 * 5. At the end narrow triangles, wedges and gaps are opened (NearDegenerateRegions).
 *
 * @param fields   are changed, see 3
 * @param goOn     told the share that is done, on the calling thread, several times a second; after
 *                 false the mesh is what there is by then: safe, but rough, or still empty
 */
InterfaceMesh MakeInterfaces(InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, const std::function<bool(double share)>& goOn);
}

#endif

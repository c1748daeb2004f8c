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
/** Parameters of MakeInterfaces(). Lengths are in computational space. */
struct InterfaceOptions
{
  double Edge = 1.36; ///< Desired mean edge length at size 1.
  /** Allowed distance of misclassified voxel centres from an interface, in the smallest spacing. */
  double VoxelTolerance = 0.;
  /** Allowed distance of faces from the interfaces of the fields; 0: uniform edge length. */
  double Tolerance = 0.;
  double MostSize = 4.;   ///< With a tolerance: maximum edge length, relative to Edge.
  double Gradation = 0.3; ///< With a tolerance: maximum growth of edge lengths per length.

  /** Maximum edge length of the result, relative to Edge and the local size. */
  static constexpr double LongestInEdge = 2.2;
};

/**
 * Create one conforming mesh of the interfaces of all objects of a label map, without
 * intersections. The method is not in the paper: the mesh is not a closed surface, and its topology
 * is fixed.
 *
 * 1. Create the initial mesh with the topology of the voxels (StartInterfaces).
 * 2. Alternate remeshing to the desired edge length (InterfaceRemesher) and vertex moves to the
 *    interfaces of the fields (MoveInterfaces).
 * 3. In these rounds, shift the fields so that each object keeps the volume of its voxels
 *    (CorrectVolumes), and push misclassified voxels (PushMisclassifiedVoxels).
 * 4. With a tolerance, lengthen edges in the last rounds as far as it allows (AdjustSizes).
 * 5. Open narrow triangles, wedges and gaps (NearDegenerateRegions).
 *
 * @param fields   changed by step 3
 * @param progress callback with the completed fraction, called on the calling thread several times
 *                 a second. Returns false to cancel: the mesh is then empty, or not smooth but free
 *                 of intersections.
 */
InterfaceMesh MakeInterfaces(InterfaceFields& fields, const InterfaceOptions& options,
  Executor& executor, const std::function<bool(double fraction)>& progress);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicNearDegenerateRegions_h
#define volumicNearDegenerateRegions_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace volumic
{
/**
 * Opens near-degenerate regions of interfaces: triangles with small angles, narrow dihedral wedges
 * at junction lines, and narrow gaps between triangles (SquaredGapBetween). Vertices are moved one
 * after another along the gradient of a narrowness measure, up to a maximum distance. A move is
 * made only if no triangles intersect, no voxel centre is misclassified by more than a tolerance,
 * and the volumes of objects are preserved.
 */
class NearDegenerateRegions
{
public:
  /**
   * All lengths are in computational space.
   * @param edge           desired edge length at size 1
   * @param tolerance      triangles at a smaller distance count as intersecting
   * @param voxelTolerance allowed distance of misclassified voxel centres from a face
   */
  NearDegenerateRegions(InterfaceMesh& mesh, const InterfaceFields& fields, double edge,
    double tolerance, double voxelTolerance);

  /** Open all regions. @param shouldContinue called regularly; returns false to stop */
  void Open(Executor& executor, const std::function<bool()>& shouldContinue);

private:
  /** Return the sorted vertices of narrow triangles and of triangles at narrow wedges and gaps. */
  std::vector<int> FindVertices(Executor& executor);
  /** Faces and their distances from a face; -1 for its neighbours in one sheet. */
  using Gaps = std::vector<std::pair<int, double>>;
  /** Return the gaps that are narrow at a face, or may be after a vertex moves by a distance. */
  Gaps FindGaps(int face, double move) const;
  /** Call visit(SquaredDeficit()) for gaps that may be narrow, after such a move. */
  template <typename Visitor>
  void ForGapsAt(int face, const Gaps& gaps, double moved, Visitor&& visit) const;
  /** Return the sum of SquaredDeficit() of all triangles, wedges and gaps at the images. */
  double Narrowness(double moved);
  bool TryMove(int v);
  bool TryMoveTo(int v, const Vector& requested);
  /** Return whether no voxel centre is misclassified when a vertex of a face moves. */
  bool KeepsVoxels(const InterfaceMesh::Face& face, std::ptrdiff_t moved,
    const MeshTriangle& before, const MeshTriangle& after) const;
  /** Add the volume changes of replacing Changed by Made to Gains, unless one becomes too large. */
  bool AddGains();
  void MoveTo(const Vector& target);

  InterfaceMesh& Mesh;
  const InterfaceFields& Fields;
  const double Edge;
  const double VoxelTolerance;
  InterfaceClearance Clearance;
  LargeVector<Vector> Start;              ///< initial positions
  std::vector<double> Gains;              ///< volume gained by each object, in voxels
  std::vector<std::array<int, 2>> Images; ///< images of the current vertex
  std::vector<int> Changed;
  std::vector<int> AtEdge;
  std::vector<int> Near;
  std::map<int, Gaps> GapsAt; ///< faces of the current vertex
  std::vector<FaceCoordinates> Made;
};
}

#endif

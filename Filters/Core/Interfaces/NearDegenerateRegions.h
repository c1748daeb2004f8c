// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicNearDegenerateRegions_h
#define volumicNearDegenerateRegions_h

#include "Core/Common/Executor.h"
#include "Core/Interfaces/InterfaceClearance.h"
#include "Core/Interfaces/InterfaceFields.h"
#include "Core/Interfaces/InterfaceMesh.h"

#include <functional>
#include <vector>

namespace volumic
{
/**
 * Opens what is narrow at the end: triangles, wedges between two interfaces about a junction line,
 * and gaps between triangles where they have nothing in common, also of vertices on lines. One
 * after another these go the way on which what is about them becomes wider, step by step, no
 * further than MostWay from where they were; only where nothing intersects then, no voxel's centre
 * comes to the wrong side by more than a tolerance, and objects keep their volumes.
 */
class NearDegenerateRegions
{
public:
  /**
   * @param edge           wanted, where sizes are 1; lengths: workspace
   * @param tolerance      nearer than that triangles are never
   * @param voxelTolerance how far voxels may be on the wrong side
   */
  NearDegenerateRegions(InterfaceMesh& mesh, const InterfaceFields& fields, double edge,
    double tolerance, double voxelTolerance);

  /** @param goOn asked now and then; after false no more is opened */
  void Open(Executor& executor, const std::function<bool()>& goOn);

private:
  /** The corners of narrow triangles, and of those about narrow wedges and gaps, sorted. */
  std::vector<int> FindVertices(Executor& executor);
  /** Calls visit(squared lack) for each gap too narrow between a face and another one. @param near
   * room */
  template <typename Visitor>
  void ForGapsAt(int face, std::vector<int>& near, Visitor&& visit) const;
  /** How narrow all is about a vertex, squared differences from what is aimed at; 0: nothing is. */
  double NarrownessAt(int v);
  double NarrownessOfImages();
  bool TryMove(int v);
  bool TryMoveTo(int v, const Vector& requested);
  /** What a face would be with its vertex at a place has no voxel on the wrong side of it. */
  bool KeepsVoxels(const InterfaceMesh::Face& face, std::ptrdiff_t moved,
    const MeshTriangle& before, const MeshTriangle& after) const;
  /** Adds what Made, in the place of Changed, gives each object to Gains, if none gets too much. */
  bool TakeVolumes();
  void Place(const Vector& target);

  InterfaceMesh& Mesh;
  const InterfaceFields& Fields;
  const double Edge;
  const double VoxelTolerance;
  InterfaceClearance Clearance;
  LargeVector<Vector> Start;              ///< where vertices were
  std::vector<double> Gains;              ///< of each object by all moves, voxels
  std::vector<std::array<int, 2>> Images; ///< of the vertex that is looked at
  std::vector<int> Changed;
  std::vector<int> AtEdge;
  std::vector<int> Near;
  std::vector<FaceCoordinates> Made;
};
}

#endif

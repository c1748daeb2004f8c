// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Judge of surfaces. It shares no code with the tested module. Complexity is at most O(n log n).
 *
 * Lengths are in the units of the points. Functions with a volume expect points in index
 * coordinates: voxel (0, 0, 0) at the origin, lengths in voxels. Test constraints on lengths in the
 * computational space of the surface, which is not the world for anisotropic voxels.
 */

#ifndef volumicSurfaceJudge_h
#define volumicSurfaceJudge_h

#include "TriangleSurface.h"

#include <cstddef>
#include <string>
#include <vector>

namespace volumic::support
{

struct TopologyVerdict
{
  /**
   * Number of edges without two consistently oriented triangles, of vertices where fans touch, and
   * of triangles with a repeated corner, which the other results ignore.
   */
  std::size_t Faults = 0;
  std::size_t UnusedPoints = 0;

  bool Closed = false;   ///< not empty, no edge with one triangle
  bool Manifold = false; ///< at most two triangles at an edge, one fan at a vertex, no degeneracy
  bool Oriented = false; ///< consistently
  bool Outward = false;  ///< all of these, and cavities have negative volumes, others positive

  int EulerCharacteristic = 0;
  int Genus = -1; ///< sum of all components, -1 unless closed, manifold and oriented
  double Area = 0.0;
  double Volume = 0.0; ///< sum of the signed volumes
  /** Signed volumes of the edge-connected components, negative for the boundary of a cavity. */
  std::vector<double> Components;
};

/** Compute the topology with CGAL's polygon mesh processing. */
TopologyVerdict JudgeTopology(const TriangleSurface& surface);

struct IntersectionVerdict
{
  std::size_t Pairs = 0;         ///< of triangles that intersect outside shared vertices and edges
  std::size_t FlatTriangles = 0; ///< triangles without area, ignored in the pairs
};

/** Count intersections with CGAL's exact predicates. */
IntersectionVerdict JudgeIntersections(const TriangleSurface& surface);

struct LengthVerdict
{
  std::size_t Edges = 0;
  double Shortest = 0.0;
  double Mean = 0.0;
  double Longest = 0.0;
  std::size_t EdgesTooShort = 0; ///< under delta
  std::size_t EdgesTooLong = 0;  ///< over 2.5 delta
  /** Pairs of vertices at least 4 edges apart and closer than (2.5 / sqrt 3) delta. */
  std::size_t NearPairs = 0;
};

/** Test the constraints of eq. 1, with a relative rounding tolerance of 1e-6 for floats. */
LengthVerdict JudgeLengths(const TriangleSurface& surface, double delta);

/**
 * Test a graded surface with a delta for each point. An edge uses the mean delta of its vertices, a
 * pair the smaller delta.
 */
LengthVerdict JudgeLengths(const TriangleSurface& surface, const std::vector<double>& deltas);

/** Radius ratio 2 r / R of incircle and circumcircle: 1 if equilateral, 0 if degenerate. */
struct ShapeVerdict
{
  double Least = 0.0;
  double Quantile01 = 0.0; ///< 1 % of the triangles are worse
  double Mean = 0.0;
};

ShapeVerdict JudgeShapes(const TriangleSurface& surface);

/** Reference volume, not owned. Outside it, the nearest voxel counts. */
struct JudgedVolume
{
  const float* Values = nullptr; ///< x fastest
  std::array<int, 3> Size = { 0, 0, 0 };
  double IsoValue = 0.0;
  bool ObjectIsBright = true;
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 }; ///< in the unit of the results
};

struct IsoDistanceVerdict
{
  double MeanAtVertices = 0.0;
  double MeanAtCentroids = 0.0;
};

/**
 * Compute the distance to the isosurface, |I - iso| / |grad I|, from trilinear interpolation of the
 * field and its central differences. Distances are clamped to 10, as the quotient is meaningless in
 * flat regions. Points in index coordinates, distances in the unit of Spacing.
 */
IsoDistanceVerdict JudgeIsoDistance(const TriangleSurface& surface, const JudgedVolume& volume);

/**
 * Return the share of the reachable voxels that lie within two voxels of a vertex, in index
 * coordinates. Reachable are object voxels with a background 6-neighbour and within 2.5 voxels of
 * the centre of a background ball of radius 1.5 voxels that is connected to the outside of the
 * volume.
 */
double ReachedShare(const TriangleSurface& surface, const JudgedVolume& volume);

struct SurfaceVerdict
{
  TopologyVerdict Topology;
  IntersectionVerdict Intersections;
  LengthVerdict Lengths;
  ShapeVerdict Shapes;

  /** Closed, manifold, outward, without intersections, unused points and flat triangles. */
  bool IsSound() const
  {
    return this->Topology.Outward && this->Topology.UnusedPoints == 0 &&
      this->Intersections.Pairs == 0 && this->Intersections.FlatTriangles == 0;
  }
};

SurfaceVerdict JudgeSurface(const TriangleSurface& surface, double delta);

/** Return a text with all results, for failing tests. */
std::string Describe(const SurfaceVerdict& verdict);

} // namespace volumic::support

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * One judge for all surfaces, ours and other people's. It shares no code with the module that it
 * judges, and works on plain arrays. Everything is at most O(n log n).
 *
 * Lengths are in the units of the points. Functions that take a volume want the points in index
 * coordinates, voxel (0, 0, 0) at the origin and one unit per voxel along each axis; then lengths
 * are voxels. Constraints on lengths have to be judged in the space in which the surface was made
 * (for anisotropic voxels that is not the world).
 *
 * All functions throw std::invalid_argument for a triangle with an index that is out of range and
 * for a coordinate that is not finite; JudgeLengths() also unless there is a delta for each point.
 */

#ifndef volumicSurfaceJudge_h
#define volumicSurfaceJudge_h

#include "TriangleSurface.h"

#include <cstddef>
#include <string>
#include <vector>

namespace volumic::support
{

//------------------------------------------------------------------------------
/** One component: triangles connected across edges. */
struct ComponentVerdict
{
  int EulerCharacteristic = 0;
  double Area = 0.0;
  double Volume = 0.0; ///< signed: negative for the boundary of a cavity
};

struct TopologyVerdict
{
  /**
   * Edges that do not have two triangles in opposite directions, vertices at which fans touch, and
   * triangles with a repeated corner, which all else leaves out.
   */
  std::size_t Faults = 0;
  std::size_t UnusedPoints = 0;

  bool Closed = false;   ///< not empty, no edge with one triangle
  bool Manifold = false; ///< no edge with three, no fans that touch, no degenerate triangle
  bool Oriented = false; ///< consistently
  bool Outward = false;  ///< all of that, positive volumes, and negative ones for cavities

  int EulerCharacteristic = 0;
  int Genus = -1; ///< sum over the components, -1 unless closed, manifold and oriented
  double Area = 0.0;
  double Volume = 0.0; ///< sum of the signed volumes
  std::vector<ComponentVerdict> Components;
};

/** By CGAL's polygon mesh processing. */
TopologyVerdict JudgeTopology(const TriangleSurface& surface);

//------------------------------------------------------------------------------
struct IntersectionVerdict
{
  /** Pairs of triangles that intersect anywhere but at a vertex or edge which they share. */
  std::size_t Pairs = 0;
  /** Triangles without area; they are left out of the pairs. */
  std::size_t FlatTriangles = 0;
};

/** With CGAL's exact predicates. */
IntersectionVerdict JudgeIntersections(const TriangleSurface& surface);

//------------------------------------------------------------------------------
struct LengthVerdict
{
  std::size_t Edges = 0;
  double Shortest = 0.0;
  double Mean = 0.0;
  double Longest = 0.0;
  std::size_t EdgesTooShort = 0; ///< under delta
  std::size_t EdgesTooLong = 0;  ///< over 2.5 delta
  /**
   * Pairs of vertices at least 4 edges apart along the surface (or on different components) and
   * nearer than (2.5 / sqrt 3) delta.
   */
  std::size_t NearPairs = 0;
};

/**
 * Constraints of eq. 1. Each edge counts once. Comparisons allow a relative rounding of 1e-6, for
 * points that went through float.
 */
LengthVerdict JudgeLengths(const TriangleSurface& surface, double delta);

/**
 * The same of a graded surface, of which each point has a delta: that of an edge is the mean of its
 * ends', that of a pair the smaller one.
 */
LengthVerdict JudgeLengths(const TriangleSurface& surface, const std::vector<double>& deltas);

//------------------------------------------------------------------------------
/**
 * Radius ratio 2 r / R of incircle and circumcircle: 1 for an equilateral triangle, 0 for a flat.
 */
struct ShapeVerdict
{
  double Least = 0.0;
  double Quantile01 = 0.0; ///< 1 % of the triangles are worse
  double Mean = 0.0;
};

ShapeVerdict JudgeShapes(const TriangleSurface& surface);

//------------------------------------------------------------------------------
/** A volume to measure against; it does not own its values. Outside, the nearest voxel counts. */
struct JudgedVolume
{
  const float* Values = nullptr; ///< x fastest
  std::array<int, 3> Size = { 0, 0, 0 };
  double IsoValue = 0.0;
  bool ObjectIsBright = true;
  /** Distance of the voxels along each axis, in the unit that distances are wanted in. */
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };
};

struct IsoDistanceVerdict
{
  double MeanAtVertices = 0.0;
  double MeanAtCentroids = 0.0;
  double Quantile99AtVertices = 0.0;
  double LargestAtVertices = 0.0;
};

/**
 * Distance to the isopotential, |I - iso| / |grad I|, from the trilinear field and the trilinear
 * interpolation of central differences. No distance counts more than `largest`: where the field is
 * flat the quotient means nothing. Points in index coordinates, result and `largest` in the unit of
 * the volume's Spacing.
 */
IsoDistanceVerdict JudgeIsoDistance(
  const TriangleSurface& surface, const JudgedVolume& volume, double largest = 10.0);

//------------------------------------------------------------------------------
struct ReachVerdict
{
  /**
   * Object voxels with a 6-neighbour of air that a ball of air of radius 1.5 voxels can reach from
   * outside the volume (within 2.5 voxels of a centre of that ball).
   */
  std::size_t ReachableVoxels = 0;
  std::size_t FoundVoxels = 0; ///< those within two voxels of a vertex
  double Share = 0.0;          ///< of the one in the other; 1 where there is nothing to reach
};

/**
 * Target Q4: did the surface get everywhere? Outside the volume is air. Points in index
 * coordinates.
 */
ReachVerdict JudgeReach(const TriangleSurface& surface, const JudgedVolume& volume);

//------------------------------------------------------------------------------
/** All of it. Volume parts are left at their defaults when no volume is given. */
struct SurfaceVerdict
{
  TopologyVerdict Topology;
  IntersectionVerdict Intersections;
  LengthVerdict Lengths;
  ShapeVerdict Shapes;
  bool HasVolume = false;
  IsoDistanceVerdict IsoDistance;
  ReachVerdict Reach;
};

/** Points, delta and volume all in index coordinates. `volume` may be null. */
SurfaceVerdict JudgeSurface(
  const TriangleSurface& surface, double delta, const JudgedVolume* volume = nullptr);

/** A few lines of text with all figures, for logs and messages of failing tests. */
std::string Describe(const SurfaceVerdict& verdict);

} // namespace volumic::support

#endif

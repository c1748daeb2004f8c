// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/TriangleTests.h"

#include "Core/Mesh/SurfaceMesh.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Normals of triangles that are folded onto each other: within 1.15 degrees of opposite. */
constexpr double FoldedCosine = -0.9998;

struct Plane
{
  VectorD Normal; ///< Not normalised.
  double Size;    ///< Length of Normal.
};

Plane PlaneOf(const VectorD* t)
{
  const VectorD normal = Cross(t[1] - t[0], t[2] - t[0]);
  return { normal, Length(normal) };
}

double Side(const double* a, const double* b, const double* c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** Return whether two segments in a plane intersect. Evaluated in double without tolerance. */
bool SegmentsCross(const double* p, const double* q, const double* a, const double* b)
{
  const double sp = Side(a, b, p);
  const double sq = Side(a, b, q);
  const double sa = Side(p, q, a);
  const double sb = Side(p, q, b);
  if (sp == 0 && sq == 0)
  {
    const int k = std::abs(b[0] - a[0]) > std::abs(b[1] - a[1]) ? 0 : 1;
    return std::max(std::min(p[k], q[k]), std::min(a[k], b[k])) <=
      std::min(std::max(p[k], q[k]), std::max(a[k], b[k]));
  }
  return ((sp <= 0 && sq >= 0) || (sp >= 0 && sq <= 0)) &&
    ((sa <= 0 && sb >= 0) || (sa >= 0 && sb <= 0));
}

bool Inside(const double* p, const double* a, const double* b, const double* c)
{
  const double s0 = Side(a, b, p);
  const double s1 = Side(b, c, p);
  const double s2 = Side(c, a, p);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool IntersectInPlane(const VectorD& normal, const VectorD& p, const VectorD& q, const VectorD* t)
{
  const double ax = std::abs(normal.X);
  const double ay = std::abs(normal.Y);
  const double az = std::abs(normal.Z);
  const int drop = (ax >= ay && ax >= az) ? 0 : (ay >= az ? 1 : 2);
  double flat[5][2];
  const VectorD* points[5] = { &p, &q, t, t + 1, t + 2 };
  for (int i = 0; i < 5; ++i)
  {
    flat[i][0] = drop == 0 ? points[i]->Y : points[i]->X;
    flat[i][1] = drop == 2 ? points[i]->Y : points[i]->Z;
  }
  return Inside(flat[0], flat[2], flat[3], flat[4]) ||
    SegmentsCross(flat[0], flat[1], flat[2], flat[3]) ||
    SegmentsCross(flat[0], flat[1], flat[3], flat[4]) ||
    SegmentsCross(flat[0], flat[1], flat[4], flat[2]);
}

/**
 * Return whether the bounding boxes of two point sets are disjoint along an axis. The tests below
 * measure distances to lines and planes. For a triangle that is nearly a line they accept points
 * far beyond its tips, which this test excludes.
 */
bool BoxesApart(
  const VectorD* p, int countP, const VectorD* q, int countQ, double VectorD::*axis, double margin)
{
  double lowP = p[0].*axis;
  double highP = lowP;
  for (int i = 1; i < countP; ++i)
  {
    lowP = std::min(lowP, p[i].*axis);
    highP = std::max(highP, p[i].*axis);
  }
  double lowQ = q[0].*axis;
  double highQ = lowQ;
  for (int i = 1; i < countQ; ++i)
  {
    lowQ = std::min(lowQ, q[i].*axis);
    highQ = std::max(highQ, q[i].*axis);
  }
  return lowP > highQ + margin || lowQ > highP + margin;
}

bool BoxesApart(const VectorD* p, int countP, const VectorD* q, int countQ, double margin)
{
  return BoxesApart(p, countP, q, countQ, &VectorD::X, margin) ||
    BoxesApart(p, countP, q, countQ, &VectorD::Y, margin) ||
    BoxesApart(p, countP, q, countQ, &VectorD::Z, margin);
}

bool SegmentIntersects(
  const VectorD& p, const VectorD& q, const VectorD* t, const Plane& plane, double tolerance)
{
  const double thick = tolerance * plane.Size;
  const double dp = Dot(plane.Normal, p - t[0]);
  const double dq = Dot(plane.Normal, q - t[0]);
  if ((dp > thick && dq > thick) || (dp < -thick && dq < -thick))
  {
    return false;
  }
  if (std::abs(dp) <= thick && std::abs(dq) <= thick)
  {
    const VectorD ends[2] = { p, q };
    return !BoxesApart(ends, 2, t, 3, tolerance) && IntersectInPlane(plane.Normal, p, q, t);
  }
  // Test the point where the segment crosses the plane, or comes nearest to it.
  const double fraction = std::min(std::max(dp / (dp - dq), 0.), 1.);
  const VectorD x = p + (q - p) * fraction;
  if (BoxesApart(&x, 1, t, 3, 2 * tolerance))
  {
    return false;
  }
  for (int k = 0; k < 3; ++k)
  {
    const VectorD edge = t[(k + 1) % 3] - t[k];
    if (Dot(Cross(edge, x - t[k]), plane.Normal) < -thick * Length(edge))
    {
      return false;
    }
  }
  return true;
}

/**
 * Return whether a plane through the common corner of two triangles separates the edges opposite to
 * it by so much that none of the tests below can find an intersection. Those tests accept points up
 * to one tolerance from the plane of a triangle. In that plane they accept points up to 3 sqrt 3
 * tolerances from the triangle, at a sharp corner, where only the bounding box limits them. Return
 * false for slivers, whose normals are unreliable.
 */
bool SeparatedAtCorner(
  const VectorD& corner, const VectorD* endsF, const VectorD* endsG, double tolerance)
{
  constexpr double leastTolerances = 8;
  constexpr double leastRatio = 1e-3;
  constexpr double leastSine = 1e-6;
  const VectorD a = endsF[0] - corner;
  const VectorD b = endsF[1] - corner;
  const VectorD c = endsG[0] - corner;
  const VectorD d = endsG[1] - corner;
  const VectorD across = a + b - c - d;
  const double length = Length(across);
  const double least = length * (leastTolerances * tolerance + leastRatio * length);
  const auto isSliver = [](const VectorD& p, const VectorD& q)
  {
    const VectorD normal = Cross(p, q);
    return !(Dot(normal, normal) > leastSine * leastSine * Dot(p, p) * Dot(q, q));
  };
  return Dot(across, a) > least && Dot(across, b) > least && Dot(across, c) < -least &&
    Dot(across, d) < -least && !isSliver(a, b) && !isSliver(c, d);
}

bool OnOneSide(
  const VectorD* points, int count, const VectorD& origin, const Plane& plane, double tolerance)
{
  const double thick = tolerance * plane.Size;
  bool above = true;
  bool below = true;
  for (int i = 0; i < count; ++i)
  {
    const double d = Dot(plane.Normal, points[i] - origin);
    above = above && d > thick;
    below = below && d < -thick;
  }
  return above || below;
}

/** Test two triangles that have corner i of the first and corner j of the second in common. */
bool IntersectBeyondCorner(const VectorD* f, int i, const VectorD* g, int j, double tolerance)
{
  const VectorD endsF[2] = { f[(i + 1) % 3], f[(i + 2) % 3] };
  const VectorD endsG[2] = { g[(j + 1) % 3], g[(j + 2) % 3] };
  if (SeparatedAtCorner(f[i], endsF, endsG, tolerance))
  {
    return false;
  }
  const Plane planeF = PlaneOf(f);
  if (OnOneSide(endsG, 2, f[0], planeF, tolerance))
  {
    return false;
  }
  const Plane planeG = PlaneOf(g);
  if (OnOneSide(endsF, 2, g[0], planeG, tolerance))
  {
    return false;
  }
  return SegmentIntersects(endsF[0], endsF[1], g, planeG, tolerance) ||
    SegmentIntersects(endsG[0], endsG[1], f, planeF, tolerance);
}
}

MeshTriangle TriangleOf(const SurfaceMesh& mesh, int a, int b, int c)
{
  return { { a, b, c },
    { VectorD(mesh.Position[a]), VectorD(mesh.Position[b]), VectorD(mesh.Position[c]) } };
}

bool TrianglesIntersect(const MeshTriangle& f, const MeshTriangle& g, double tolerance)
{
  int inF[3];
  int inG[3];
  int shared = 0;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (f.Vertex[i] == g.Vertex[j] && shared < 3)
      {
        inF[shared] = i;
        inG[shared++] = j;
      }
    }
  }
  if (shared == 3)
  {
    return true;
  }
  if (shared == 0 && BoxesApart(f.Corner, 3, g.Corner, 3, tolerance))
  {
    return false;
  }
  if (shared == 1)
  {
    return IntersectBeyondCorner(f.Corner, inF[0], g.Corner, inG[0], tolerance);
  }
  const Plane planeF = PlaneOf(f.Corner);
  if (shared == 2)
  {
    const Plane planeG = PlaneOf(g.Corner);
    // Consistently oriented neighbours traverse their edge in opposite directions.
    const bool isForwardInF = (inF[1] - inF[0] + 3) % 3 == 1;
    const bool isForwardInG = (inG[1] - inG[0] + 3) % 3 == 1;
    const double side = isForwardInF != isForwardInG ? 1. : -1.;
    return side * Dot(planeF.Normal, planeG.Normal) < FoldedCosine * planeF.Size * planeG.Size;
  }
  if (OnOneSide(g.Corner, 3, f.Corner[0], planeF, tolerance))
  {
    return false;
  }
  const Plane planeG = PlaneOf(g.Corner);
  if (OnOneSide(f.Corner, 3, g.Corner[0], planeG, tolerance))
  {
    return false;
  }
  for (int k = 0; k < 3; ++k)
  {
    if (SegmentIntersects(f.Corner[k], f.Corner[(k + 1) % 3], g.Corner, planeG, tolerance) ||
      SegmentIntersects(g.Corner[k], g.Corner[(k + 1) % 3], f.Corner, planeF, tolerance))
    {
      return true;
    }
  }
  return false;
}
}

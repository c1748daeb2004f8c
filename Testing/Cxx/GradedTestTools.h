// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicGradedTestTools_h
#define volumicGradedTestTools_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceCheck.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "EvolutionTestTools.h"

namespace volumic
{
inline Grading Within(double tolerance)
{
  Grading grading;
  grading.Tolerance = tolerance;
  return grading;
}

/** How far outside a box with rounded edges. */
inline double OutsideBox(double x, double y, double z, const std::array<double, 3>& half, double radius)
{
  const double a = std::max(std::abs(x) - half[0] + radius, 0.);
  const double b = std::max(std::abs(y) - half[1] + radius, 0.);
  const double c = std::max(std::abs(z) - half[2] + radius, 0.);
  return std::sqrt(a * a + b * b + c * c) - radius;
}

/** Large flat sides, edges with a radius of three voxels, and a ball beside it. */
inline double OutsideBoxAndBall(double x, double y, double z)
{
  const double box = OutsideBox(x - 20.3, y - 19.6, z - 18.2, { 13., 12., 9. }, 3.);
  return std::min(box, Distance(x, y, z, 20., 20., 38.) - 5.5);
}

/** How far a place is outside of something. */
using Outside = std::function<double(double x, double y, double z)>;

/** What is nearer than 0 to something is more than half. */
inline TestVolume VolumeOf(const Outside& outside)
{
  return MakeVolume(48, [&outside](double x, double y, double z)
    { return std::clamp(0.5 - 0.25 * outside(x, y, z), 0., 1.); });
}

/** The surface of something, on one level. */
inline SurfaceResult SurfaceOf(const Outside& outside, const Grading& grading)
{
  const TestVolume volume = VolumeOf(outside);
  Monitor silent;
  TestEvolution evolution(IsoHalf(), Threads, silent);
  evolution.Task.Grading = grading;
  evolution.StartEnclosing(volume.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  EXPECT_EQ(evolution.Verified().Found, 0);
  return evolution.Result();
}

/** Calls visit(u, v, length) for each edge, twice. */
inline void VisitEdges(
  const IndexedSurface& surface, const std::function<void(int, int, double)>& visit)
{
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point& a = surface.Points[t[k]];
      const Point& b = surface.Points[t[(k + 1) % 3]];
      visit(t[k], t[(k + 1) % 3], Distance(a[0], a[1], a[2], b[0], b[1], b[2]));
    }
  }
}

inline void ExpectLegal(const SurfaceResult& surface)
{
  EXPECT_EQ(CountSelfIntersections(surface), 0);
  EXPECT_NO_THROW(CheckInitialSurface(surface)) << "closed, oriented, manifold";
  int outside = 0;
  VisitEdges(surface,
    [&](int u, int v, double length)
    {
      const double delta = 0.5 * (surface.Size[u] + surface.Size[v]);
      outside += length < 0.999 * delta || length > 2.501 * delta;
    });
  EXPECT_EQ(outside, 0);
}
}

#endif

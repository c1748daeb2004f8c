// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/TriangleDistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace volumic;

namespace
{
constexpr int Steps = 40;

VectorD SamplePoint(const VectorD* t, int i, int j)
{
  return t[0] + (t[1] - t[0]) * (static_cast<double>(i) / Steps) +
    (t[2] - t[0]) * (static_cast<double>(j) / Steps);
}

/** Call visit(point) for sample points of a triangle, including its edges and corners. */
void ForSamplePoints(const VectorD* t, const std::function<void(const VectorD&)>& visit)
{
  for (int i = 0; i <= Steps; ++i)
  {
    for (int j = 0; i + j <= Steps; ++j)
    {
      visit(SamplePoint(t, i, j));
    }
  }
}

MeshTriangle RandomTriangle(std::mt19937& random, int first)
{
  MeshTriangle t;
  for (int k = 0; k < 3; ++k)
  {
    const auto next = [&] { return static_cast<double>(random() % 1000) / 1000.; };
    t.Vertex[k] = first + k;
    t.Corner[k] = VectorD(next(), next(), next());
  }
  return t;
}

double GapBetween(const MeshTriangle& f, const MeshTriangle& g)
{
  return std::sqrt(SquaredGapBetween(f, g));
}
}

TEST(TriangleDistance, MatchesSampledMinimum)
{
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n)
  {
    const MeshTriangle t = RandomTriangle(random, 0);
    const VectorD point = RandomTriangle(random, 3).Corner[0];
    double nearest = 9.;
    ForSamplePoints(
      t.Corner, [&](const VectorD& at) { nearest = std::min(nearest, Length(point - at)); });
    const double distance = std::sqrt(SquaredDistanceToTriangle(point, t.Corner));
    EXPECT_LE(distance, nearest + 1e-12);
    EXPECT_GT(distance, nearest - 1.8 / Steps);
  }
}

TEST(TriangleDistance, GapMatchesSampledMinimum)
{
  std::mt19937 random(2);
  for (int n = 0; n < 60; ++n)
  {
    const MeshTriangle f = RandomTriangle(random, 0);
    MeshTriangle g = RandomTriangle(random, 3);
    for (VectorD& corner : g.Corner)
    {
      corner.X += 1.1;
    }
    double nearest = 9.;
    ForSamplePoints(f.Corner,
      [&](const VectorD& a)
      {
        ForSamplePoints(
          g.Corner, [&](const VectorD& b) { nearest = std::min(nearest, Length(a - b)); });
      });
    EXPECT_LE(GapBetween(f, g), nearest + 1e-12);
    EXPECT_GT(GapBetween(f, g), nearest - 3.6 / Steps);
    EXPECT_NEAR(GapBetween(f, g), GapBetween(g, f), 1e-12);
  }
}

TEST(TriangleDistance, GapIgnoresSharedVertices)
{
  const VectorD a(0, 0, 0);
  const VectorD b(1, 0, 0);
  const MeshTriangle f{ { 0, 1, 2 }, { a, b, VectorD(0, 1, 0) } };
  // A common edge: unfolded and folded.
  EXPECT_NEAR(GapBetween(f, { { 1, 0, 3 }, { b, a, VectorD(0, -1, 0) } }), std::sqrt(.5), 1e-12);
  EXPECT_NEAR(GapBetween(f, { { 1, 0, 3 }, { b, a, VectorD(.2, .2, .1) } }), .1, 1e-12);
  // A common corner: opposite and nearly coplanar.
  EXPECT_NEAR(GapBetween(f, { { 0, 3, 4 }, { a, VectorD(-1, 0, 0), VectorD(0, -1, 0) } }),
    std::sqrt(.5), 1e-12);
  EXPECT_NEAR(
    GapBetween(f, { { 0, 3, 4 }, { a, VectorD(.3, .3, .05), VectorD(0, 0, 1) } }), .05, 1e-12);
  // An edge above another one.
  EXPECT_NEAR(
    GapBetween(f, { { 2, 3, 4 }, { VectorD(0, 1, 0), VectorD(.5, -.5, .02), VectorD(0, .5, 2) } }),
    .04 / 3., 1e-4);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What the editor and the polish take for well-shaped: faces, edges, stars.

#include "Core/Common/Box.h"
#include "Core/Surface/FaceShape.h"
#include "Core/Surface/StarScore.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
/** A face over the edge from (0, 0, 0) to (1, 0, 0). */
MeshTriangle FaceWithTip(double x, double y, double z)
{
  return { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { x, y, z } } };
}
}

TEST(FaceShape, AspectIsHeightOverLongestEdge)
{
  EXPECT_NEAR(AspectOf(FaceWithTip(0.5, std::sqrt(0.75), 0)), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(AspectOf(FaceWithTip(0.5, 0.01, 0)), 0.01, 1e-12);
  EXPECT_EQ(AspectOf(FaceWithTip(0.5, 0, 0)), 0.);
  EXPECT_TRUE(IsWellShaped(FaceWithTip(0.5, 0.1, 0)));
  EXPECT_FALSE(IsWellShaped(FaceWithTip(0.5, 0.05, 0)));
}

TEST(FaceShape, SliversMayOnlyGetBetter)
{
  EXPECT_TRUE(KeepsShape(FaceWithTip(0.5, 0.01, 0), FaceWithTip(0.5, 0.02, 0)));
  EXPECT_FALSE(KeepsShape(FaceWithTip(0.5, 0.02, 0), FaceWithTip(0.5, 0.01, 0)));
  EXPECT_FALSE(KeepsShape(FaceWithTip(0.5, 0.8, 0), FaceWithTip(0.5, 0.01, 0)));
}

TEST(FaceShape, OnlyFacesWithANormalCanTurnTooMuch)
{
  const MeshTriangle flat = FaceWithTip(0.5, 0.8, 0);
  EXPECT_TRUE(TurnsLittle(flat, FaceWithTip(0.5, 0.8, 0.3), 0.7));
  EXPECT_FALSE(TurnsLittle(flat, FaceWithTip(0.5, 0.1, 0.8), 0.7));
  EXPECT_FALSE(TurnsLittle(flat, FaceWithTip(0.5, -0.8, 0), 0.)) << "its orientation is flipped";
  EXPECT_TRUE(TurnsLittle(FaceWithTip(0.5, 0.01, 0), FaceWithTip(0.5, 0, 0.8), 0.7)) << "a sliver";
}

TEST(StarScore, OfAFaceIsItsRadiusRatio)
{
  const float height = std::sqrt(0.75f);
  EXPECT_NEAR(FaceScore(Vector(0, 0, 0), Vector(1, 0, 0), Vector(0.5f, height, 0)), 1, 1e-5);
  // Right-angled with sides 3, 4, 5: circles of radius 1 and 2.5.
  EXPECT_NEAR(FaceScore(Vector(0, 0, 0), Vector(3, 0, 0), Vector(0, 4, 0)), 0.8, 1e-5);
  EXPECT_EQ(FaceScore(Vector(0, 0, 0), Vector(0, 0, 0), Vector(1, 0, 0)), -1);
}

TEST(StarScore, OfAnEdgeIsNegativeWhereItsLengthIsIllegal)
{
  const SizingField sizing(2);
  EXPECT_EQ(EdgeScore(sizing, 0, 1, 3 * 3), 1);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 1.9f * 1.9f), 0);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 5.1f * 5.1f), 0);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 6 * 6), EdgeScore(sizing, 0, 1, 5.1f * 5.1f));
}

TEST(StarScore, IsThatOfTheWorst)
{
  const Bench bench(DividedIcosahedron({ 0, 0, 0 }, 10, 1.6));
  const int v = bench.State.Mesh.Rings[0].Item[0];
  const Vector p = bench.State.Mesh.Position[v];
  const float before = StarScore(bench.State, v, p);
  EXPECT_GT(before, 0.7f);
  const Vector end = bench.State.Mesh.Position[bench.State.Mesh.Rings[v].Item[0]];
  EXPECT_LT(StarScore(bench.State, v, p + (end - p) * 0.3f), before);
  EXPECT_LT(StarScore(bench.State, v, p + (end - p) * 0.9f), 0) << "an edge is too short";
}

TEST(Box, TellsWhatIsApart)
{
  const Box box = Box::Of(Vector(0, 0, 0), Vector(1, 2, 0), Vector(0, 1, 3));
  EXPECT_TRUE(box.Contains(Vector(1, 2, 3)));
  EXPECT_FALSE(box.Contains(Vector(1.1f, 1, 1)));
  const Box other = { Vector(1.2f, 0, 0), Vector(2, 1, 1) };
  EXPECT_TRUE(box.IsApartFrom(other));
  EXPECT_TRUE(other.IsApartFrom(box));
  EXPECT_FALSE(box.Grown(0.3f).IsApartFrom(other));
  for (const Vector& way : { Vector(1.1f, 0, 0), Vector(0, 2.1f, 0), Vector(0, 0, 3.1f) })
  {
    const Box moved = { box.Low + way, box.High + way };
    EXPECT_TRUE(box.IsApartFrom(moved));
    EXPECT_TRUE(moved.IsApartFrom(box));
    EXPECT_FALSE(box.Contains(moved.High));
    EXPECT_FALSE(moved.Contains(box.Low));
  }
  EXPECT_FALSE(box.With(other).IsApartFrom(other));
  EXPECT_TRUE(box.With(other).Contains(Vector(2, 2, 3)));
}

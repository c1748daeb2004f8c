// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Lengths, cones of normals, and what the editor and the polish take for well-shaped.
#include "Core/Common/Box.h"
#include "Core/Surface/FaceShape.h"
#include "Core/Surface/NormalCone.h"
#include "Core/Surface/SizingField.h"
#include "Core/Surface/StarScore.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(SizingField, LooksAsFarAsTrianglesReach)
{
  const SizingField sizing(1.f);
  // Two that intersect may have their nearest corners no further apart than this: an edge of one
  // through the middle of the other, both as large as they may be.
  EXPECT_GE(sizing.Reach(0), sizing.Clearance(0, 1));
  EXPECT_GE(sizing.SmallestReach(), sizing.Reach(0));
  EXPECT_LT(sizing.Reach(0), sizing.LongestEdge(0, 1));
  EXPECT_LT(sizing.Contact(0), 1e-3 * sizing.ShortestEdge(0, 1));
}

TEST(SizingField, GrowsForLongEdgesOnly)
{
  const SizingField sizing(1.f);
  EXPECT_EQ(sizing.ForEdgesOf(2.f).OfLevel(), 1.f);
  EXPECT_EQ(sizing.ForEdgesOf(5.f).OfLevel(), 2.f);
  EXPECT_GE(sizing.ForEdgesOf(3.3f).LongestEdge(0, 1), 3.3f * (1 - 1e-6f));
}

TEST(NormalCone, IsOpposedToOneThatFacesIt)
{
  const NormalCone up(Vector(0, 0, 1), 1);
  const NormalCone down(Vector(0, 0, -1), 1);
  EXPECT_TRUE(AreOpposed(up, down));
  EXPECT_FALSE(AreOpposed(up, up));
}

TEST(NormalCone, IsOpposedWhereItIsWide)
{
  // Axes at 120 degrees: both cones together must have more than 30.
  const NormalCone up(Vector(0, 0, 1), std::cos(0.25f));
  const Vector aside(std::sin(2.0943951f), 0, std::cos(2.0943951f));
  EXPECT_FALSE(AreOpposed(up, NormalCone(aside, std::cos(0.25f))));
  EXPECT_TRUE(AreOpposed(up, NormalCone(aside, std::cos(0.30f))));
  EXPECT_TRUE(AreOpposed(up, NormalCone(Vector(0, 0, 1), -0.1f))) << "wider than a half space";
}

namespace
{
/** A face over the edge from (0, 0, 0) to (1, 0, 0). */
MeshTriangle FaceWithTip(double x, double y, double z)
{
  return { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { x, y, z } } };
}
}

TEST(FaceShape, SliversMayOnlyGetBetter)
{
  EXPECT_TRUE(KeepsShape(FaceWithTip(0.5, 0.01, 0), FaceWithTip(0.5, 0.02, 0)));
  EXPECT_FALSE(KeepsShape(FaceWithTip(0.5, 0.02, 0), FaceWithTip(0.5, 0.01, 0)));
  EXPECT_FALSE(KeepsShape(FaceWithTip(0.5, 0.8, 0), FaceWithTip(0.5, 0.01, 0)));
}

TEST(StarScore, OfAnEdgeIsNegativeWhereItsLengthIsIllegal)
{
  const SizingField sizing(2);
  EXPECT_EQ(EdgeScore(sizing, 0, 1, 3 * 3), 1);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 1.9f * 1.9f), 0);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 5.1f * 5.1f), 0);
  EXPECT_LT(EdgeScore(sizing, 0, 1, 6 * 6), EdgeScore(sizing, 0, 1, 5.1f * 5.1f));
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

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/NormalCone.h"
#include "Core/Surface/SizingField.h"
#include "TestPrelude.h"

using namespace volumic;

TEST(SizingField, KeepsToEquationOne)
{
  const SizingField sizing(2.f);
  EXPECT_EQ(sizing.ShortestEdge(0, 1), 2.f);
  EXPECT_EQ(sizing.LongestEdge(0, 1), 5.f);
  EXPECT_EQ(sizing.LongestEdge(0, 1, 0.5f), 2.5f);
  // lambda is the circumradius of the largest legal triangle, of three edges of 2.5.
  EXPECT_NEAR(sizing.Clearance(0, 1), 2. * 2.5 / std::sqrt(3.), 1e-5);
  EXPECT_EQ(sizing.LargestClearance(0, 0.5f), 0.5f * sizing.Clearance(0, 1));
  EXPECT_EQ(sizing.InDelta(0, 1, 3.f), 1.5f);
}

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

TEST(SizingField, MeasuresInDeltaOfTheLevel)
{
  const SizingField sizing(0.85f);
  EXPECT_EQ(sizing.OfLevel(), 0.85f);
  EXPECT_EQ(sizing.At(7), 0.85f);
  EXPECT_LE(sizing.Smallest(), sizing.At(7));
  EXPECT_GE(sizing.Largest(), sizing.At(7));
  EXPECT_GT(sizing.RestLength(0, 1), sizing.ShortestEdge(0, 1));
  EXPECT_LT(sizing.RestLength(0, 1), sizing.LongestEdge(0, 1));
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

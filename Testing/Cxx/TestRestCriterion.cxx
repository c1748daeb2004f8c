// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/RestCriterion.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
/** Whether a surface rests that has had these volumes, one every fifth iteration. */
bool Rests(const std::vector<double>& volumes, double limit)
{
  RestCriterion rest;
  for (double volume : volumes)
  {
    rest.Add(volume);
  }
  return rest.IsMet(limit);
}
}

TEST(RestCriterion, NeedsTwentyIterations)
{
  EXPECT_FALSE(Rests({}, 1.));
  EXPECT_FALSE(Rests({ 10, 10, 10, 10 }, 1.)) << "15 iterations after the first look";
  EXPECT_TRUE(Rests({ 10, 10, 10, 10, 10 }, 1.));
}

TEST(RestCriterion, LooksAtTheLastTenAndTheLastTwentyIterations)
{
  EXPECT_TRUE(Rests({ 10.5, 90, 10.5, 90, 10 }, 1.)) << "nothing but these is looked at";
  EXPECT_FALSE(Rests({ 12, 10, 10, 10, 10 }, 1.)) << "it has shrunk before";
  EXPECT_FALSE(Rests({ 8, 10, 10, 10, 10 }, 1.)) << "or grown";
  EXPECT_FALSE(Rests({ 10, 10, 12, 10, 10 }, 1.)) << "it goes to and fro";
  EXPECT_FALSE(Rests({ 10, 10, 8, 10, 10 }, 1.));
  EXPECT_FALSE(Rests({ 0, 0, 0, 12, 10, 10, 10, 11 }, 1.)) << "less than the limit is asked for";
}

TEST(RestCriterion, ForgetsTheLevelBefore)
{
  RestCriterion rest;
  for (int i = 0; i < 5; ++i)
  {
    rest.Add(10);
  }
  ASSERT_TRUE(rest.IsMet(1.));
  rest.Reset();
  EXPECT_FALSE(rest.IsMet(1.));
  rest.Add(10);
  EXPECT_FALSE(rest.IsMet(1.));
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgeLengthPlan.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
const LevelSize Size = { 256, 256, 108 };
const std::array<double, 3> Spacing = { 0.957, 0.957, 1.5 };
const double Unit = 0.957;
const double LeastRatio = std::sqrt(3.) / 2.5;

std::string ErrorOf(double length)
{
  return ErrorMessageOf([&] { PlanEdgeLength(length, Size, Spacing, EdgeLengthPreferences()); });
}
}

TEST(EdgeLengthPlan, UsesPreferencesWherePossible)
{
  for (int level = 0; level < 4; ++level)
  {
    const double length = MeanEdgeInDelta * 0.85 * Unit * std::pow(std::sqrt(3.), level);
    const EdgeLengthPlan plan = PlanEdgeLength(length, Size, Spacing, EdgeLengthPreferences());
    EXPECT_EQ(plan.FinestLevel, level);
    EXPECT_NEAR(plan.ReductionFactor, std::sqrt(3.), 1e-9);
    EXPECT_NEAR(plan.SamplingRatio, 0.85, 1e-9);
  }
}

TEST(EdgeLengthPlan, CoversAllLengthsBetweenLevels)
{
  for (double length = 0.6 * Unit; length < 10. * Unit; length *= 1.02)
  {
    const EdgeLengthPlan plan = PlanEdgeLength(length, Size, Spacing, EdgeLengthPreferences());
    const double delta =
      plan.SamplingRatio * std::pow(plan.ReductionFactor, plan.FinestLevel) * Unit;
    EXPECT_NEAR(MeanEdgeInDelta * delta, length, 1e-6 * length);
    EXPECT_GE(plan.SamplingRatio, LeastRatio - 1e-9);
    EXPECT_LE(plan.SamplingRatio, 1. + 1e-9);
    EXPECT_GT(plan.ReductionFactor, 1.44);
    EXPECT_LT(plan.ReductionFactor, 2.);
    PyramidOptions options;
    options.ReductionFactor = plan.ReductionFactor;
    EXPECT_LT(plan.FinestLevel, static_cast<int>(PlanPyramid(Size, Spacing, options).size()));
  }
}

TEST(EdgeLengthPlan, ReportsPossibleLengths)
{
  EXPECT_TRUE(Has(
    ErrorOf(0.2), "Edge Length is 0.2, but edges of this image can have mean lengths of 0.566"));
  EXPECT_TRUE(Has(ErrorOf(0.2), "Resample the image more finely"));
  EXPECT_TRUE(Has(ErrorOf(100.), "Give a shorter one"));
  EXPECT_TRUE(Has(ErrorOf(0.), "it must be 0 (automatic) or a length"));
  EXPECT_TRUE(Has(ErrorOf(std::nan("")), "it must be 0 (automatic) or a length"));
  EXPECT_TRUE(Has(ErrorOf(INFINITY), "it must be 0 (automatic) or a length"));
}

TEST(EdgeLengthPlan, SelectsNearestLevelOfPyramid)
{
  const std::vector<double> units = { 1., std::sqrt(3.), 3. };
  EdgeLengthPreferences preferences;
  EdgeLengthPlan plan = PlanEdgeLength(MeanEdgeInDelta * 0.9 * std::sqrt(3.), units, preferences);
  EXPECT_EQ(plan.FinestLevel, 1);
  EXPECT_NEAR(plan.SamplingRatio, 0.9, 1e-9);
  plan = PlanEdgeLength(MeanEdgeInDelta * 0.5, units, preferences);
  EXPECT_EQ(plan.FinestLevel, -1);
  EXPECT_NEAR(plan.SamplingRatio / plan.ReductionFactor, 0.5, 1e-9);
  // Ratios from 1 to 1.2 are not covered by levels 0 and 1.
  EXPECT_THROW(PlanEdgeLength(MeanEdgeInDelta * 1.1, units, preferences), std::invalid_argument);
}

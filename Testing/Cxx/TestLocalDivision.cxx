// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "GradedTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
SequentialExecutor Alone;

/** A plate, turned about two axes, as a scanner shows it: all of it fades over a third of a voxel. */
Outside OutsideBlurredPlate(double thickness)
{
  return [thickness](double x, double y, double z)
  {
    const double u = 0.8 * (x - 24.) + 0.6 * (y - 24.);
    const double v = -0.6 * (x - 24.) + 0.8 * (y - 24.);
    const double across = 0.96 * (z - 24.) + 0.28 * u;
    const double along = 0.96 * u - 0.28 * (z - 24.);
    const double rim = std::max(std::abs(along) - 16., std::abs(v) - 15.);
    return std::max(3. * (std::abs(across) - 0.5 * thickness), rim);
  };
}

/** The same from a level of sqrt 3 times the edges, on the same voxels. */
struct TwoLevels
{
  SurfaceResult Divided; ///< As it comes to the finer level,
  SurfaceResult AtRest;  ///< and when it rests there.
  LostParts Lost;
};
TwoLevels SurfaceOfTwoLevels(const Outside& outside,
  const Grading& grading, double fineUnit = 1., Executor& executor = Alone, int size = 48)
{
  const TestVolume volume = VolumeOf(outside, size);
  LevelImage coarse = volume.Image;
  coarse.Unit = fineUnit * std::sqrt(3.);
  LevelImage fine = volume.Image;
  fine.Unit = fineUnit;
  Monitor silent;
  TestEvolution evolution(IsoHalf(), executor, silent);
  evolution.StartEnclosing(coarse, 1);
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  evolution.Task.Grading = grading;
  TwoLevels result;
  EXPECT_TRUE(evolution.Divide(fine, 0));
  result.Divided = evolution.Result();
  const StopReason reason = evolution.Run();
  EXPECT_TRUE(reason == StopReason::Converged || reason == StopReason::LimitCycle);
  EXPECT_EQ(evolution.Verified().Found, 0);
  result.AtRest = evolution.Result();
  result.Lost = evolution.Lost();
  return result;
}

Grading ThinParts()
{
  Grading grading;
  grading.ThinParts = true;
  return grading;
}
}

TEST(LocalDivision, IsDividedOnlyWhereAToleranceAsksForIt)
{
  const SurfaceResult coarse = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(100.)).Divided;
  ExpectLegal(coarse);
  EXPECT_GT(*std::min_element(coarse.Size.begin(), coarse.Size.end()), 1.4f * 0.85f)
    << "a tolerance that all of it keeps divides nothing";
  constexpr double tolerance = 0.25;
  const TwoLevels some = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(tolerance));
  ExpectLegal(some.AtRest);
  EXPECT_GT(some.Divided.Points.size(), 1.03 * coarse.Points.size());
  EXPECT_LT(some.Divided.Points.size(), 2 * coarse.Points.size());
  // It is as good as one that was divided everywhere.
  const SurfaceResult whole = SurfaceOf(OutsideBoxAndBall, Within(tolerance), Alone);
  EXPECT_GT(some.AtRest.FitToTolerance->WithinTolerance,
    whole.FitToTolerance->WithinTolerance - 0.005);
  EXPECT_LT(some.AtRest.Points.size(), 1.1 * whole.Points.size());
  EXPECT_NEAR(ComputeFeatures(some.AtRest).Volume, ComputeFeatures(whole).Volume,
    0.002 * ComputeFeatures(whole).Volume);
}

TEST(LocalDivision, IsDividedEverywhereWhereNearlyAllOfItAsksForThat)
{
  const TwoLevels all = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(1e-3));
  EXPECT_TRUE(all.Divided.Size.empty()) << "it is even until it rests";
  ExpectLegal(all.AtRest);
}

TEST(LocalDivision, HoldsAnObliquePlateWithoutHoles)
{
  const TwoLevels levels =
    SurfaceOfTwoLevels(OutsideBlurredPlate(1.), ThinParts(), 1. / std::sqrt(3.));
  ExpectLegal(levels.AtRest);
  const SurfaceFeatures features = ComputeFeatures(levels.AtRest);
  EXPECT_EQ(features.Components.size(), 1u);
  EXPECT_EQ(features.Genus, 0);
  EXPECT_EQ(levels.Lost.MissingBoundary, 0.);
}

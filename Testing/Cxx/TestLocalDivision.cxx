// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "GradedTestTools.h"
#include "ThreadTestTools.h"

using namespace volumic;

namespace
{
Executor Alone;

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

/** A thick box, and a plate of about a voxel that stands off from one of its sides. */
double OutsideBoxAndPlate(double x, double y, double z)
{
  return std::min(OutsideBox(x - 16.2, y - 24.1, z - 24.3, { 9., 14., 14. }, 3.),
    OutsideBox(x - 36.4, y - 24.1, z - 24.3, { 9., 9., 0.6 }, 0.5));
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

TEST(LocalDivision, FollowsThinPartsAloneWithShorterEdges)
{
  // Triangles of level 0 cannot hold the plate; those of the box are what they were.
  const double below = 1. / std::sqrt(3.);
  const TwoLevels levels = SurfaceOfTwoLevels(OutsideBoxAndPlate, ThinParts(), below);
  const SurfaceResult& surface = levels.AtRest;
  ExpectLegal(surface);
  EXPECT_FALSE(surface.FitToTolerance);
  const SurfaceFeatures features = ComputeFeatures(surface);
  ASSERT_EQ(features.Components.size(), 2u);
  EXPECT_EQ(features.Genus, 0);
  EXPECT_EQ(levels.Lost.MissingBoundary, 0.);
  ASSERT_EQ(surface.Thickness.size(), surface.Points.size());
  const float delta = 0.85f;
  std::size_t large = 0;
  std::size_t ofBox = 0;
  std::size_t ofPlate = 0;
  std::size_t small = 0;
  for (std::size_t p = 0; p < surface.Points.size(); ++p)
  {
    const bool isOfPlate = surface.Points[p][0] > 29.;
    const bool isInside = surface.Points[p][0] < 43. && std::abs(surface.Points[p][1] - 24.1) < 7.;
    const bool isFar = surface.Points[p][0] < 20.;
    ofBox += isFar;
    large += isFar && surface.Size[p] > 0.99f * delta;
    ofPlate += isOfPlate && isInside;
    small += isOfPlate && isInside && surface.Size[p] < 0.8f * delta;
    if (isFar)
    {
      EXPECT_FLOAT_EQ(surface.Thickness[p], Grading::MostThickness * delta * static_cast<float>(below))
        << "nothing is near";
    }
    if (isOfPlate && isInside)
    {
      EXPECT_NEAR(surface.Thickness[p], 1.2, 0.4) << "the plate's";
    }
  }
  EXPECT_GT(large, 0.99 * ofBox);
  EXPECT_GT(ofPlate, 200u);
  EXPECT_GT(small, 0.95 * ofPlate);
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

TEST(LocalDivision, IsLeftWhereItIsStopped)
{
  class StopInDivision final : public Monitor
  {
  public:
    explicit StopInDivision(int at) : Last(at) {}
    bool GoOn(const Status& status) override
    {
      this->Asked += status.Doing == Activity::Dividing;
      return this->Asked < this->Last;
    }

    int Asked = 0;

  private:
    int Last;
  };
  const TestVolume volume = VolumeOf(OutsideBoxAndBall);
  LevelImage coarse = volume.Image;
  coarse.Unit = std::sqrt(3.);
  std::size_t before = 0;
  for (const int at : { 1, 2, 3, 100 })
  {
    SCOPED_TRACE(at);
    StopInDivision monitor(at);
    TestEvolution evolution(IsoHalf(), Alone, monitor);
    evolution.StartEnclosing(coarse, 1);
    ASSERT_EQ(evolution.Run(), StopReason::Converged);
    evolution.Task.Grading = Within(0.25);
    const std::size_t coarsePoints = evolution.Result().Points.size();
    ASSERT_TRUE(evolution.Divide(volume.Image, 0));
    EXPECT_EQ(evolution.IsStopped(), at < 100);
    EXPECT_GE(monitor.Asked, std::min(at, 3)) << "before edges are split, meanwhile, in the end";
    const SurfaceResult divided = evolution.Result();
    EXPECT_EQ(divided.Points.size() == coarsePoints, at == 1);
    EXPECT_GE(divided.Points.size(), before);
    before = divided.Points.size();
    EXPECT_EQ(evolution.Run(), at < 100 ? StopReason::Cancelled : StopReason::Converged);
    EXPECT_EQ(evolution.Verified().Found, 0);
    EXPECT_EQ(CountSelfIntersections(evolution.Result()), 0);
    EXPECT_NO_THROW(CheckInitialSurface(evolution.Result()));
  }
}

TEST(LocalDivision, OfTwoLevelsIsTheSameOnAnyThreads)
{
  const double below = 1. / std::sqrt(3.);
  constexpr int size = 60;
  Grading grading = Within(0.25);
  grading.MaximumEdgeLength = 3.;
  EXPECT_TRUE(HasSeveralBlocks(size, grading.MaximumEdgeLength / 2.5));
  for (const bool thin : { false, true })
  {
    SCOPED_TRACE(thin);
    const auto run = [&](Executor& executor)
    {
      return thin ? SurfaceOfTwoLevels(OutsideBoxAndPlate, ThinParts(), below, executor, size).AtRest
                  : SurfaceOfTwoLevels(OutsideBoxAndBall, grading, 1., executor, size).AtRest;
    };
    const SurfaceResult one = run(Alone);
    ExpectLegal(one);
    DelayedThreads three(3, 5, 40, 7);
    ExpectSame(one, run(three));
  }
}

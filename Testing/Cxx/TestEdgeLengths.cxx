// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgeLengthPlan.h"
#include "Core/Mesh/SurfaceCheck.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
Grading Within(double tolerance)
{
  Grading grading;
  grading.Tolerance = tolerance;
  return grading;
}

/** Return the signed distance of a box with rounded edges. */
double OutsideBox(double x, double y, double z, const std::array<double, 3>& half, double radius)
{
  const double a = std::max(std::abs(x) - half[0] + radius, 0.);
  const double b = std::max(std::abs(y) - half[1] + radius, 0.);
  const double c = std::max(std::abs(z) - half[2] + radius, 0.);
  return std::sqrt(a * a + b * b + c * c) - radius;
}

/** Return the signed distance of a rounded box and a ball. */
double OutsideBoxAndBall(double x, double y, double z)
{
  const double box = OutsideBox(x - 20.3, y - 19.6, z - 18.2, { 13., 12., 9. }, 3.);
  return std::min(box, Distance(x, y, z, 20., 20., 38.) - 5.5);
}

/** Signed distance, positive outside. */
using Outside = std::function<double(double x, double y, double z)>;

TestVolume VolumeOf(const Outside& outside)
{
  return MakeVolume(48,
    [&outside](double x, double y, double z)
    { return std::clamp(0.5 - 0.25 * outside(x, y, z), 0., 1.); });
}

/** Segment an object on one level. */
SurfaceResult SurfaceOf(const Outside& outside, const Grading& grading)
{
  const TestVolume volume = VolumeOf(outside);
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  evolution.Task.Grading = grading;
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
  EXPECT_EQ(evolution.Verified().Found, 0);
  return evolution.Result();
}

void ExpectLegal(const SurfaceResult& surface)
{
  EXPECT_NO_THROW(CheckInitialSurface(surface)) << "closed, manifold, oriented, no intersection";
  int outside = 0;
  VisitEdges(surface,
    [&](int u, int v, double length)
    {
      const double delta = 0.5 * (surface.Size[u] + surface.Size[v]);
      outside += length < 0.999 * delta || length > 2.501 * delta;
    });
  EXPECT_EQ(outside, 0);
}

/** Return the position along, beside and across an oblique plate. */
Point InPlate(double x, double y, double z)
{
  const double u = 0.8 * (x - 24.) + 0.6 * (y - 24.);
  const double v = -0.6 * (x - 24.) + 0.8 * (y - 24.);
  return { 0.96 * u - 0.28 * (z - 24.), v, 0.96 * (z - 24.) + 0.28 * u };
}

/** Return the signed distance of a plate. */
Outside OutsidePlate(double thickness)
{
  return [thickness](double x, double y, double z)
  {
    const auto [along, beside, across] = InPlate(x, y, z);
    return OutsideBox(
      along, beside, across, { 16., 15., 0.5 * thickness }, std::min(1., 0.5 * thickness));
  };
}

/** Return the distance of a plate of one voxel whose sides are blurred over a third of a voxel. */
double OutsideBlurredPlate(double x, double y, double z)
{
  const auto [along, beside, across] = InPlate(x, y, z);
  const double link = std::max(std::abs(along) - 16., std::abs(beside) - 15.);
  return std::max(3. * (std::abs(across) - 0.5), link);
}

/** Surfaces of two levels with a factor of sqrt 3, on the same voxels. */
struct TwoLevels
{
  SurfaceResult Divided;   ///< at the start of the finer level
  SurfaceResult Converged; ///< at its end
  MissedParts Missed;
};
TwoLevels SurfaceOfTwoLevels(const Outside& outside, const Grading& grading, double fineUnit = 1.)
{
  const TestVolume volume = VolumeOf(outside);
  LevelImage coarse = volume.Image;
  coarse.Unit = fineUnit * std::sqrt(3.);
  LevelImage fine = volume.Image;
  fine.Unit = fineUnit;
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  EXPECT_EQ(evolution.RunEnclosing(coarse, 1), StopReason::Converged);
  evolution.Task.Grading = grading;
  TwoLevels result;
  EXPECT_TRUE(evolution.Divide(fine, 0));
  result.Divided = evolution.Result();
  const StopReason reason = evolution.Run();
  EXPECT_TRUE(reason == StopReason::Converged || reason == StopReason::LimitCycle);
  EXPECT_EQ(evolution.Verified().Found, 0);
  result.Converged = evolution.Result();
  result.Missed = evolution.Missed();
  return result;
}

const LevelSize Size = { 256, 256, 108 };
const std::array<double, 3> Spacing = { 0.957, 0.957, 1.5 };
const double Unit = 0.957;
const double LeastRatio = std::sqrt(3.) / 2.5;

std::string ErrorOf(double length)
{
  return ErrorMessageOf([&] { PlanEdgeLength(length, Size, Spacing, EdgeLengthPreferences()); });
}
}

TEST(GradedSizing, HasLargerSearchRadiusThanUniformSizing)
{
  const LargeVector<float> sizes = { 1.f, 4.f };
  const SizingField even(1.f);
  EXPECT_EQ(even.RadiusFactor(), 1.f);
  float before = even.SearchRadius(0);
  for (const double gradation : { .1, .2, .3 })
  {
    SCOPED_TRACE(gradation);
    const SizingField sizing = even.Graded(sizes, 4.f, static_cast<float>(gradation));
    EXPECT_GT(sizing.SearchRadius(0), before);
    before = sizing.SearchRadius(0);
    // From v to a point of its star, then to a corner of a face that grows with the distance d:
    // d = .36 longest + (1 + g d) 2.5 / sqrt 3, in delta.
    const double longest = 1. / (1. - 1.25 * gradation); // delta of an edge: mean of its vertices
    const double furthest =
      (.36 * longest + 2.5 / std::sqrt(3.)) / (1. - gradation * 2.5 / std::sqrt(3.));
    EXPECT_GT(sizing.SearchRadius(0), furthest);
    EXPECT_EQ(sizing.SearchRadius(1), SizingField(4.f).SearchRadius(1)) << "the largest size";
  }
  // During evolution the largest and smallest sizes may meet.
  const SizingField any = even.Graded(sizes, 4.f, 1.f);
  EXPECT_EQ(any.SearchRadius(0), SizingField(4.f).SearchRadius(0));
}

TEST(GradedSurface, RespectsGradationAndMaximumEdgeLength)
{
  Grading grading = Within(2.);
  grading.MaximumEdgeLength = 5.;
  const SurfaceResult surface = SurfaceOf(OutsideBoxAndBall, grading);
  ExpectLegal(surface);
  double longest = 0., steepest = 0.;
  VisitEdges(surface,
    [&](int u, int v, double length)
    {
      longest = std::max(longest, length);
      steepest = std::max(steepest, std::abs(surface.Size[u] - surface.Size[v]) / length);
    });
  EXPECT_LE(longest, 5.);
  EXPECT_GT(longest, 4.) << "the bound must be reached";
  // Vertices have moved since the sizes were computed.
  EXPECT_LT(steepest, 1.5 * grading.Gradation);
  EXPECT_FLOAT_EQ(*std::max_element(surface.Size.begin(), surface.Size.end()), 2.f);
}

TEST(GradedSurface, PreservesThinWalls)
{
  for (const double thickness : { 1.5, 2.5, 4. })
  {
    SCOPED_TRACE(thickness);
    const SurfaceResult plate = SurfaceOf(OutsidePlate(thickness), Within(1.));
    ExpectLegal(plate);
    const SurfaceFeatures features = ComputeFeatures(plate);
    EXPECT_EQ(features.Components.size(), 1u);
    EXPECT_EQ(features.Genus, 0);
    // The thickness, not curvature or tolerance, limits the sizes.
    const auto large = std::count_if(plate.Size.begin(), plate.Size.end(),
      [thickness](float delta) { return delta > std::max(1., 0.5 * thickness); });
    EXPECT_LT(large, 0.15 * plate.Size.size()) << "except at the border of the plate";
  }
}

TEST(LocalDivision, DividesOnlyWhereToleranceRequires)
{
  const SurfaceResult coarse = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(100.)).Divided;
  ExpectLegal(coarse);
  EXPECT_GT(*std::min_element(coarse.Size.begin(), coarse.Size.end()), 1.4f * 0.85f)
    << "not divided";
  constexpr double tolerance = 0.25;
  const TwoLevels some = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(tolerance));
  ExpectLegal(some.Converged);
  EXPECT_GT(some.Divided.Points.size(), 1.03 * coarse.Points.size());
  EXPECT_LT(some.Divided.Points.size(), 2 * coarse.Points.size());
  const SurfaceResult whole = SurfaceOf(OutsideBoxAndBall, Within(tolerance));
  EXPECT_GT(
    some.Converged.FitToTolerance->WithinTolerance, whole.FitToTolerance->WithinTolerance - 0.005);
  EXPECT_LT(some.Converged.Points.size(), 1.1 * whole.Points.size());
  EXPECT_NEAR(ComputeFeatures(some.Converged).Volume, ComputeFeatures(whole).Volume,
    0.002 * ComputeFeatures(whole).Volume);
}

TEST(LocalDivision, DividesEverywhereForSmallTolerance)
{
  const TwoLevels all = SurfaceOfTwoLevels(OutsideBoxAndBall, Within(1e-3));
  EXPECT_TRUE(all.Divided.Size.empty()) << "uniform until convergence";
  ExpectLegal(all.Converged);
}

TEST(LocalDivision, PreservesObliquePlate)
{
  Grading thinParts;
  thinParts.ThinParts = true;
  const TwoLevels levels = SurfaceOfTwoLevels(OutsideBlurredPlate, thinParts, 1. / std::sqrt(3.));
  ExpectLegal(levels.Converged);
  const SurfaceFeatures features = ComputeFeatures(levels.Converged);
  EXPECT_EQ(features.Components.size(), 1u);
  EXPECT_EQ(features.Genus, 0);
  EXPECT_EQ(levels.Missed.MissingBoundary, 0.);
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

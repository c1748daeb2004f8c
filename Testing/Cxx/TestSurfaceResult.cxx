// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

TEST(SurfaceResult, IsCloserToIsosurfaceWithSnapping)
{
  const TestVolume volume = BallVolume(28, 8);
  double residual[2] = { 0, 0 };
  for (const bool snap : { false, true })
  {
    SurfaceOptions options = IsoHalf();
    options.SnapToIsoValue = snap;
    TestEvolution evolution(options, Threads, Silent);
    evolution.StartEnclosing(volume.Image, 0);
    EXPECT_EQ(evolution.Run(), StopReason::Converged);
    const SurfaceResult surface = evolution.Result();
    residual[snap] = std::accumulate(surface.Residual.begin(), surface.Residual.end(), 0.,
      [&](double sum, float x) { return sum + std::abs(x) / surface.Residual.size(); });
    ExpectLegalEdges(surface);
    EXPECT_EQ(CountSelfIntersections(surface), 0);
    const double volumeOfBall = 4. / 3. * 3.14159265 * 512.;
    EXPECT_NEAR(ComputeFeatures(surface).Volume, volumeOfBall, 0.03 * volumeOfBall);
  }
  EXPECT_LT(residual[true], 0.003);
  EXPECT_GT(residual[false], 2 * residual[true]);
}

TEST(SurfaceResult, LiesOnGivenEdges)
{
  // The edge is one voxel inside the isosurface. Snapping must not leave it.
  TestVolume volume = BallVolume(28, 8);
  const TestVolume map = MakeVolume(28,
    [](double x, double y, double z)
    {
      const double r = Distance(x, y, z, 14, 14, 14) - 7.;
      return std::exp(-0.5 * r * r);
    });
  volume.Image.Edges = map.Values.data();
  SurfaceOptions options = IsoHalf();
  options.EdgeAttractionWeight = 4;
  TestEvolution evolution(options, Threads, Silent);
  evolution.StartEnclosing(volume.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  double radius = 0;
  const SurfaceResult surface = evolution.Result();
  for (const Point& p : surface.Points)
  {
    radius += Distance(p[0], p[1], p[2], 14, 14, 14) / static_cast<double>(surface.Points.size());
  }
  EXPECT_NEAR(radius, 7, 0.08);
}

TEST(SurfaceStart, SeedsHaveRequestedRadiusWithLowerBound)
{
  const TestVolume volume = BallVolume(40, 16);
  for (const double radius : { 0., 0.1, 2., 5. })
  {
    SurfaceOptions options = IsoHalf();
    options.SeedRadius = radius;
    TestEvolution evolution(options, Threads, Silent);
    EXPECT_EQ(evolution.StartSeeds(volume.Image, 0, { { 20, 20, 20 } }), 1);
    const SurfaceResult surface = evolution.Result();
    ExpectLegalEdges(surface);
    const Point& p = surface.Points.front();
    const double expected =
      radius == 0 ? 1.2 * surface.Delta : std::max(radius, 0.96 * surface.Delta);
    EXPECT_NEAR(Distance(p[0], p[1], p[2], 20, 20, 20), expected, 1e-4);
  }
}

TEST(SurfaceEvolutionInvalid, RejectsOptionsOutOfRange)
{
  struct Case
  {
    const char* Name;
    double SurfaceOptions::*Option;
    double TooLow;
    double TooHigh;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Case> cases = { { "Sampling Ratio", &SurfaceOptions::SamplingRatio, 0.6, 1.01 },
    { "Friction", &SurfaceOptions::Friction, 0., 1e7 },
    { "Seed Radius", &SurfaceOptions::SeedRadius, -1., 1e10 },
    { "Convergence Tolerance", &SurfaceOptions::ConvergenceTolerance, -1e-9, 1.1 },
    { "MaximumStep", &SurfaceOptions::MaximumStep, 0., 0.51 } };
  for (const WeightOfForce& weight : WeightsOfForces)
  {
    cases.push_back({ weight.Name, weight.Value, -0.1, 1e7 });
  }
  for (const Case& c : cases)
  {
    for (const double value : { c.TooLow, c.TooHigh, none })
    {
      SurfaceOptions options = IsoHalf();
      options.*c.Option = value;
      const std::string error = ErrorMessageOf([&] { CheckOptions(options); });
      EXPECT_EQ(error.find(c.Name), 0u) << c.Name << " " << value << ": " << error;
    }
  }
}

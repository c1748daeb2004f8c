// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "CoreTestTools.h"
#include "EvolutionTestTools.h"
#include "ThreadTestTools.h"

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
    EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
    const SurfaceResult surface = evolution.Result();
    for (const float x : surface.Residual)
    {
      residual[snap] += std::abs(x) / static_cast<double>(surface.Residual.size());
    }
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
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
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
    double TooLow, TooHigh;
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

TEST(SurfaceFeatures, SortsByAreaAndSignsVolume)
{
  IndexedSurface surface = InsideOut(Cuboid({ 4, 4, 4 }, { 6, 6, 6 })); // a cavity
  AddSurface(surface, Cuboid({ 0, 0, 0 }, { 10, 10, 10 }));
  const SurfaceFeatures features = ComputeFeatures(surface);
  ASSERT_EQ(features.Components.size(), 2u);
  EXPECT_NEAR(features.Components[0].Volume, 1000, 1e-6);
  EXPECT_NEAR(features.Components[1].Volume, -8, 1e-9);
  EXPECT_NEAR(features.Volume, 992, 1e-6);
  EXPECT_EQ(features.ComponentOfTriangle.front(), 1);
  EXPECT_EQ(features.ComponentOfTriangle.back(), 0);
  EXPECT_EQ(features.EulerCharacteristic, 4);
}

TEST(SurfaceFeatures, AreIndependentOfThreads)
{
  // Boxes of equal size, distinguished by their order only, with interleaved triangles.
  constexpr int count = 3000;
  IndexedSurface surface;
  const IndexedSurface unit = Cuboid({ 0, 0, 0 }, { 1, 1, 1 });
  for (int b = 0; b < count; ++b)
  {
    for (const Point& p : unit.Points)
    {
      surface.Points.push_back({ 2. * (b % 50) + p[0], 2. * (b / 50) + p[1], p[2] });
    }
  }
  surface.Points.push_back({ 0, 0, 9 }); // Not in any triangle.
  for (const Triangle& t : unit.Triangles)
  {
    for (int b = count - 1; b >= 0; --b)
    {
      surface.Triangles.push_back({ 8 * b + t[0], 8 * b + t[1], 8 * b + t[2] });
    }
  }
  const SurfaceFeatures one = ComputeFeatures(surface);
  ASSERT_EQ(one.Components.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(one.ComponentOfTriangle.front(), 0) << "in the order of their first triangles";
  Executor threads(3);
  ScrambledExecutor backwards(1);
  for (Executor* executor :
    { static_cast<Executor*>(&threads), static_cast<Executor*>(&backwards) })
  {
    const SurfaceFeatures other = ComputeFeatures(surface, *executor);
    ASSERT_EQ(other.Components.size(), one.Components.size());
    EXPECT_EQ(one.ComponentOfTriangle, other.ComponentOfTriangle);
    for (int c = 0; c < count; ++c)
    {
      ASSERT_EQ(other.Components[c].Vertices, 8);
      ASSERT_EQ(other.Components[c].Triangles, 12);
      ASSERT_EQ(one.Components[c].Centroid, other.Components[c].Centroid);
    }
  }
}

TEST(SurfaceFeatures, InertiaIsAboutCentroid)
{
  // A tetrahedron with three perpendicular edges, far from the origin. All its moments are known.
  const double leg[3] = { 2, 3, 5 };
  const Point at = { 100, -50, 7 };
  IndexedSurface surface;
  surface.Points = { at, { at[0] + leg[0], at[1], at[2] }, { at[0], at[1] + leg[1], at[2] },
    { at[0], at[1], at[2] + leg[2] } };
  surface.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  const ComponentFeatures found = ComputeFeatures(surface).Components.at(0);
  const double volume = leg[0] * leg[1] * leg[2] / 6;
  EXPECT_NEAR(found.Volume, volume, 1e-9);
  double about[3][3]; // Covariances times the volume.
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_NEAR(found.Centroid[i], at[i] + leg[i] / 4, 1e-9);
    for (int j = 0; j < 3; ++j)
    {
      about[i][j] = volume * leg[i] * leg[j] * ((i == j ? 1. / 10 : 1. / 20) - 1. / 16);
    }
  }
  EXPECT_NEAR(found.Inertia[0], about[1][1] + about[2][2], 1e-8);
  EXPECT_NEAR(found.Inertia[1], about[0][0] + about[2][2], 1e-8);
  EXPECT_NEAR(found.Inertia[2], about[0][0] + about[1][1], 1e-8);
  // xy, yz, xz with the sign of the tensor.
  EXPECT_NEAR(found.Inertia[3], -about[0][1], 1e-8);
  EXPECT_NEAR(found.Inertia[4], -about[1][2], 1e-8);
  EXPECT_NEAR(found.Inertia[5], -about[0][2], 1e-8);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
double Work(const TestEvolution& evolution)
{
  double work = 0;
  for (const HistoryRow& row : evolution.History())
  {
    work += row.Vertices;
  }
  return work;
}
}

TEST(Termination, StopsNoiseAsLimitCycle)
{
  std::mt19937 engine(5);
  const TestVolume volume = MakeVolume(
    20, [&engine](double, double, double) { return static_cast<double>(engine()) / 4294967296.; });
  SurfaceOptions options = IsoHalf();
  options.Friction = 0.3;
  options.ConvergenceTolerance = 0.;
  TestEvolution evolution(options, Threads, Silent);
  evolution.StartEnclosing(volume.Image, 0);
  const StopReason reason = evolution.Run();
  EXPECT_EQ(reason, StopReason::LimitCycle) << Describe(reason);
  EXPECT_STREQ(Describe(reason), "limit cycle");
  EXPECT_LT(evolution.Iterations(), 400);
  const SurfaceResult surface = evolution.Result();
  EXPECT_EQ(CountSelfIntersections(surface, 1), 0);
  ExpectEdgesWithin(surface, surface.Delta * (1 - 1e-5), 1e9);
}

TEST(Termination, BoundsWorkForReplicatedCheckerboard)
{
  const TestVolume volume = MakeVolume(20,
    [](double x, double y, double z)
    { return (static_cast<int>(x / 3) + static_cast<int>(y / 3) + static_cast<int>(z / 3)) % 2; });
  SurfaceOptions options = IsoHalf();
  options.IsoValue = 0.45;
  options.BorderValue = Border::Replicate;
  options.IsopotentialWeight = 75.;
  options.Friction = 0.65;
  options.ConvergenceTolerance = 0.;
  options.FreezeMotionlessVertices = false;
  TestEvolution evolution(options, Threads, Silent);
  evolution.StartEnclosing(volume.Image, 0);
  evolution.Run();
  EXPECT_LT(Work(evolution), 2e6);
}

TEST(Termination, ConvergesWithStrongInternalForces)
{
  // Stiff forces must not oscillate with the time step.
  const TestVolume volume = BallVolume(28, 9);
  for (const auto& weights : { std::pair<double, double>(0.2, 100.), { 100., 0.1 } })
  {
    SurfaceOptions options = IsoHalf();
    options.TensionWeight = weights.first;
    options.ElasticityWeight = weights.second;
    TestEvolution evolution(options, Threads, Silent);
    evolution.StartEnclosing(volume.Image, 0);
    EXPECT_EQ(evolution.Run(), StopReason::Converged) << weights.first;
    EXPECT_LT(Work(evolution), 6e5) << weights.first;
    const double volumeOfBall = 4. / 3. * 3.14159265 * 729.;
    EXPECT_NEAR(ComputeFeatures(evolution.Result()).Volume, volumeOfBall, 0.1 * volumeOfBall)
      << weights.first;
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
/** Count faults of the surface between two sweeps. */
int CountFaults(const TestEvolution& evolution)
{
  const SurfaceResult surface = evolution.Result();
  const SurfaceMesh mesh = MeshOf(surface);
  return !DescribeBrokenInvariant(mesh).empty() + CountSelfIntersections(surface, 1) +
    (mesh.CountEulerCharacteristic() != evolution.History().back().EulerCharacteristic);
}

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

TEST(SurfaceEvolution, IsValidInLongBox)
{
  // Noise in voxels of 1 : 7.5.
  std::mt19937 engine(60158);
  std::uniform_real_distribution<double> noise(0., 1.);
  TestVolume volume = MakeVolume(16, [&](double, double, double) { return noise(engine); });
  volume.Image.Size = { 11, 17, 19 };
  volume.Image.Step = { 3., 3.07, 22.6 };
  volume.Image.Unit = 3.;
  SurfaceOptions options = IsoHalf();
  options.MaximumNumberOfIterations = 12;
  TestEvolution evolution(options, Threads, Silent);
  int faults = 0;
  evolution.AfterSweep = [&] { faults += CountFaults(evolution); };
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::IterationLimit);
  EXPECT_EQ(faults, 0);
  ExpectValidMesh(evolution.Result());
  ExpectLegalEdges(evolution.Result());
}

TEST(SurfaceEvolution, IsValidAfterEachSweep)
{
  // A noisy torus.
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0., 0.2);
  const TestVolume volume = MakeVolume(36,
    [&](double x, double y, double z)
    {
      const double q = std::hypot(x - 18, y - 18) - 10.08;
      return Soft(std::hypot(q, z - 18) - 4.32) + noise(engine);
    });
  TestEvolution evolution(IsoHalf(), Threads, Silent);
  int calls = 0, faults = 0;
  evolution.AfterSweep = [&]
  {
    ++calls;
    faults += CountFaults(evolution);
  };
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged);
  EXPECT_GT(calls, 5);
  EXPECT_EQ(faults, 0);
  const SurfaceFeatures features = ComputeFeatures(evolution.Result());
  EXPECT_EQ(features.Components[0].Genus, 1);
}

TEST(SurfaceEvolution, PreservesTopologyOnRequest)
{
  // Without cuts the surface around two balls has one component.
  const TestVolume volume = MakeVolume(36,
    [](double x, double y, double z) {
      return Soft(std::min(Distance(x, y, z, 9, 18, 18) - 6., Distance(x, y, z, 27, 18, 18) - 6.));
    });
  SurfaceOptions options = IsoHalf();
  options.TopologyChanges = false;
  options.MaximumNumberOfIterations = 150;
  TestEvolution evolution(options, Threads, Silent);
  evolution.RunEnclosing(volume.Image, 0);
  EXPECT_EQ(ComputeFeatures(evolution.Result()).Components.size(), 1u);
  EXPECT_EQ(CountSelfIntersections(evolution.Result()), 0);
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
  const StopReason reason = evolution.RunEnclosing(volume.Image, 0);
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
  evolution.RunEnclosing(volume.Image, 0);
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
    EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Converged) << weights.first;
    EXPECT_LT(Work(evolution), 6e5) << weights.first;
    const double volumeOfBall = 4. / 3. * 3.14159265 * 729.;
    EXPECT_NEAR(ComputeFeatures(evolution.Result()).Volume, volumeOfBall, 0.1 * volumeOfBall)
      << weights.first;
  }
}

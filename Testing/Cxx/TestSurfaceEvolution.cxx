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
  evolution.StartEnclosing(volume.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::IterationLimit);
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
  int calls = 0;
  int faults = 0;
  evolution.AfterSweep = [&]
  {
    ++calls;
    faults += CountFaults(evolution);
  };
  evolution.StartEnclosing(volume.Image, 0);
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
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
  evolution.StartEnclosing(volume.Image, 0);
  evolution.Run();
  EXPECT_EQ(ComputeFeatures(evolution.Result()).Components.size(), 1u);
  EXPECT_EQ(CountSelfIntersections(evolution.Result()), 0);
}

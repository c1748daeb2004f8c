// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
/** Return the largest distance beyond the outermost voxels along an axis. */
double Beyond(const SurfaceResult& surface, const LevelImage& image)
{
  double furthest = 0;
  for (const Point& p : surface.Points)
  {
    for (int k = 0; k < 3; ++k)
    {
      furthest = std::max({ furthest, -p[k], p[k] - (image.Size[k] - 1) * image.Step[k] });
    }
  }
  return furthest;
}

SurfaceOptions Replicating()
{
  SurfaceOptions options = IsoHalf();
  options.BorderValue = Border::Replicate;
  return options;
}

/** Return the largest valid distance: margin, ramp and delta. */
double Most(const LevelImage& image, double delta)
{
  double most = 0;
  for (const double step : image.Step)
  {
    most = std::max(most, std::max(2. * image.Unit, step) + image.Unit + delta);
  }
  return most;
}
}

TEST(ImageMargin, ReplicatedObjectClosesAtMargin)
{
  // A rod along x that crosses the image.
  TestVolume volume = MakeVolume(
    16, [](double, double y, double z) { return Soft(std::hypot(y - 8., z - 8.) - 4.); });
  for (const double step : { 1., 2.5 }) // the margin is at least one voxel
  {
    volume.Image.Step[0] = step;
    SurfaceOptions options = Replicating();
    options.MaximumNumberOfIterations = 300;
    TestEvolution evolution(options, Threads, Silent);
    evolution.StartSeeds(volume.Image, 0, { { 8 * step, 8, 8 } });
    EXPECT_EQ(evolution.Run(), StopReason::Converged);
    const double beyond = Beyond(evolution.Result(), volume.Image);
    EXPECT_GT(beyond, std::max(2., step) - 0.2) << "replicated up to the margin";
    EXPECT_LT(beyond, std::max(2., step) + 0.7);
    EXPECT_EQ(ComputeFeatures(evolution.Result()).Components.size(), 1u);
  }
}

TEST(ImageMargin, BoundsSurfaceForAnySettings)
{
  std::mt19937 engine(7);
  const auto uniform = [&engine](double low, double high)
  { return low + (high - low) * (static_cast<double>(engine()) / 4294967296.); };
  for (int run = 0; run < 24; ++run)
  {
    const double wave = uniform(0.3, 1.2);
    TestVolume volume = MakeVolume(12,
      [&](double x, double y, double z)
      { return 0.5 + std::sin(wave * x) * std::cos(wave * y) + uniform(-0.3, 0.3) + 0.05 * z; });
    const TestVolume edges = MakeVolume(
      12, [&](double x, double, double z) { return uniform(0., 1.) + 0.2 * x - 0.1 * z; });
    volume.Image.Step = { 1., 1., uniform(1., 4.) };
    const auto weight = [&](double probability)
    { return uniform(0., 1.) < probability ? std::pow(10., uniform(-2., 3.5)) : 0.; };
    SurfaceOptions options = Replicating();
    options.BorderValue = run % 3 == 0 ? Border::Background : Border::Replicate;
    options.TensionWeight = weight(0.7);
    options.ElasticityWeight = weight(0.7);
    options.IsopotentialWeight = run % 4 == 0 ? weight(0.5) : 1.;
    options.GradientWeight = weight(0.3);
    options.EdgeAttractionWeight = weight(0.4);
    options.Friction = std::pow(10., uniform(-2., 1.5));
    options.FreezeMotionlessVertices = run % 2 == 0;
    options.MaximumNumberOfIterations = 40;
    if (options.EdgeAttractionWeight > 0)
    {
      volume.Image.Edges = edges.Values.data();
    }
    TestEvolution evolution(options, Threads, Silent);
    double furthest = 0;
    evolution.AfterSweep = [&]
    { furthest = std::max(furthest, Beyond(evolution.Result(), volume.Image)); };
    if (run % 2 == 0)
    {
      evolution.StartSeeds(volume.Image, 0, {});
    }
    else
    {
      evolution.StartEnclosing(volume.Image, 0);
    }
    const double start = Beyond(evolution.Result(), volume.Image);
    evolution.Run();
    const SurfaceResult surface = evolution.Result();
    EXPECT_LT(std::max(furthest, Beyond(surface, volume.Image)),
      std::max(start + 1e-3, Most(volume.Image, surface.Delta)))
      << "run " << run;
    EXPECT_EQ(CountSelfIntersections(surface, 1), 0) << "run " << run;
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Final test of a surface for intersections, and repair by remeshing.
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/NewFaces.h"
#include "EvolutionTestTools.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
/** Pull a vertex through the opposite side. */
void Pierce(SurfaceState& state)
{
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (state.Mesh.IsAlive(v))
    {
      const Vector p = state.Mesh.Position[v];
      const Vector centre(16, 16, 16);
      state.MoveTo(v, centre + (centre - p) * 1.3f);
      return;
    }
  }
}

/** Optionally cancels after the surface has been pierced. */
class PierceMonitor final : public Monitor
{
public:
  bool CanContinue = true;
  bool HasPierced = false;

  bool GoOn(const Status&) override { return this->CanContinue || !this->HasPierced; }
};

/** Cancels at the n-th query. */
class StopAt final : public Monitor
{
public:
  explicit StopAt(int n) : Left(n) {}
  bool GoOn(const Status&) override { return --this->Left > 0; }

  int Left;
};

SurfaceOptions TwentyIterations()
{
  SurfaceOptions options = IsoHalf();
  options.MaximumNumberOfIterations = 20;
  return options;
}
}

TEST(Verification, DetectsIntersectionsOfParallelSheets)
{
  // Nearby normals are never opposite: the balls are shifted by less than an edge.
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 10, 1.6);
  AddSurface(surface, DividedIcosahedron({ 0.3, 0, 0 }, 10, 1.6));
  LiveSurface bench(surface);
  Proximity proximity;
  proximity.Test(bench, bench.All(), OnThisThread());
  EXPECT_TRUE(proximity.Intersections().empty()) << "not found by the proximity test";
  EXPECT_GT(CountIntersecting(bench, OnThisThread()), 0u);
}

TEST(Verification, AgreesWithTriangleTree)
{
  // From no intersection to many.
  std::mt19937 engine(27);
  std::uniform_real_distribution<float> shift(-1.f, 1.f);
  int intersecting = 0;
  for (int scene = 0; scene < 60; ++scene)
  {
    LiveSurface bench(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6));
    const float most = 0.02f * static_cast<float>(scene);
    for (const int v : bench.All())
    {
      bench.MoveTo(
        v, bench.Mesh.Position[v] + Vector(shift(engine), shift(engine), shift(engine)) * most);
    }
    bench.UpdateShape();
    const bool found = CountSelfIntersections(bench.Mesh.ToIndexed(), 1) > 0;
    EXPECT_EQ(CountIntersecting(bench, OnThisThread()) > 0, found) << "scene " << scene;
    intersecting += found;
  }
  EXPECT_GT(intersecting, 10);
  EXPECT_LT(intersecting, 50);
}

TEST(Verification, RepairsSurfaceOfLevel)
{
  const TestVolume volume = BallVolume(32, 10);
  TestEvolution undisturbed(TwentyIterations(), Threads, Silent);
  undisturbed.RunEnclosing(volume.Image, 0);
  EXPECT_EQ(undisturbed.Verified().Found, 0);
  const double requested = ComputeFeatures(undisturbed.Result()).Volume;
  for (const bool canContinue : { true, false })
  {
    PierceMonitor monitor;
    monitor.CanContinue = canContinue;
    TestEvolution evolution(TwentyIterations(), Threads, monitor);
    evolution.AfterSweep = [&]
    {
      monitor.HasPierced = evolution.Iterations() == 20;
      if (monitor.HasPierced)
      {
        Pierce(evolution.Current->State);
      }
    };
    EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0),
      canContinue ? StopReason::IterationLimit : StopReason::Cancelled);
    EXPECT_GT(evolution.Verified().Found, 0);
    EXPECT_EQ(evolution.Verified().Left, 0);
    EXPECT_TRUE(Has(evolution.Verified().Describe(3), "level 3 intersected itself at "));
    EXPECT_TRUE(Has(evolution.Verified().Describe(3), "another mesh"));
    EXPECT_EQ(evolution.IsStopped(), !canContinue) << "the repair is not cancelled";
    const SurfaceResult surface = evolution.Result();
    EXPECT_EQ(CountSelfIntersections(surface), 0);
    const SurfaceFeatures features = ComputeFeatures(surface);
    EXPECT_LE(features.EulerCharacteristic, 2) << "the repair may add a handle";
    EXPECT_NEAR(features.Volume, requested, 0.1 * requested)
      << "cancelled surfaces are not snapped";
  }
}

TEST(Verification, ReturnsValidSurfacesOfNoise)
{
  // Independent voxels, strong forces, little friction. Test snapshots, and cancelled runs. With
  // these seeds the surface intersects itself if displacements are not rolled back.
  for (const unsigned seed : { 7u, 17u, 22u, 23u })
  {
    std::mt19937 random(seed);
    const auto value = [&random] { return std::generate_canonical<double, 24>(random); };
    const TestVolume volume =
      MakeVolume(10, [&](double, double, double) { return value() < 0.4 ? 1000. : 0.; });
    LevelImage fine = volume.Image;
    fine.Unit = 1. / SizingField::DivisionFactor;
    SurfaceOptions options = TwentyIterations();
    options.IsoValue = 500.;
    options.IsopotentialWeight = 1e3 * value();
    options.TensionWeight = 10. * value();
    options.Friction = 0.01 + value();
    bool isCancelled = true;
    for (int query = 1; isCancelled; query += 1 + query / 2)
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", query " << query);
      StopAt monitor(query);
      TestEvolution evolution(options, Threads, monitor);
      evolution.Task.Observe = [](int, const std::function<SurfaceResult()>& take)
      { ExpectValidMesh(take()); };
      evolution.Task.Grading.ThinParts = seed % 2 == 1;
      evolution.RunEnclosing(volume.Image, 0);
      if (!evolution.IsStopped() && evolution.Divide(fine, -1))
      {
        evolution.Run();
      }
      EXPECT_EQ(evolution.Verified().Found, 0);
      ExpectValidMesh(evolution.Result());
      isCancelled = monitor.Left <= 0;
    }
  }
}

TEST(Verification, OmitsIntersectingSnapshots)
{
  const TestVolume volume = BallVolume(32, 10);
  TestEvolution evolution(TwentyIterations(), Threads, Silent);
  std::vector<std::size_t> points;
  evolution.Task.Observe = [&](int iteration, const std::function<SurfaceResult()>& take)
  {
    if (iteration == 20)
    {
      Pierce(evolution.Current->State);
    }
    points.push_back(take().Points.size());
  };
  evolution.RunEnclosing(volume.Image, 0);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_GT(*std::min_element(points.begin(), points.end() - 1), 0u);
  EXPECT_EQ(points.back(), 0u) << "omitted";
}

TEST(Verification, ReportsUnrepairableSurface)
{
  const TestVolume volume = BallVolume(32, 10);
  PierceMonitor monitor;
  monitor.CanContinue = false;
  TestEvolution evolution(TwentyIterations(), Threads, monitor);
  evolution.AfterSweep = [&]
  {
    monitor.HasPierced = true;
    SurfaceState& state = evolution.Current->State;
    for (int v = 0; v < state.Mesh.Size(); ++v)
    {
      if (state.Mesh.IsAlive(v))
      {
        Vector p = state.Mesh.Position[v];
        p.Z = 16;
        state.MoveTo(v, p);
      }
    }
  };
  EXPECT_EQ(evolution.RunEnclosing(volume.Image, 0), StopReason::Cancelled);
  EXPECT_GT(evolution.Verified().Found, 0);
  EXPECT_EQ(evolution.Verified().Left, evolution.Verified().Found);
  EXPECT_TRUE(Has(evolution.Verified().Describe(0), "could not be mended"));
  EXPECT_FALSE(evolution.Result().Points.empty()) << "returned unrepaired";
}

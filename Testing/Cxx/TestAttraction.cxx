// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Image/EdgeAttraction.h"
#include "Core/Image/PointAttraction.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
/** 100 for x < 6, 0 above, with a ramp of two voxels. */
TestVolume Half()
{
  return MakeVolume(33, [](double x, double, double) { return 100. * Soft(x - 6.); });
}
}

TEST(PointAttraction, AddsHalfStrengthAtRadius)
{
  // Value V = -50 relative to the iso-value, slope 50 per voxel: V + e (2 |V| + 50 / 4), e = 1/2.
  const TestVolume volume = Half();
  const std::vector<float> bent = PointAttraction({ { { 20, 16, 16 }, 1., 4. } }, 1.)
                                    .Bend(volume.Image, WithIso(50), OnThisThread());
  for (const std::array<int, 3>& voxel :
    { std::array<int, 3>{ 24, 16, 16 }, { 20, 12, 16 }, { 20, 16, 20 } })
  {
    EXPECT_NEAR(bent[voxel[0] + 33 * (voxel[1] + 33 * voxel[2])], 50 - 50 + 0.5 * 112.5, 0.05);
  }
}

TEST(PointAttraction, ChangesOnlyVoxelsInRangeForAnyThreadCount)
{
  const TestVolume volume = Half();
  const PointAttraction attraction({ { { 20, 16, 16 }, 1., 3. }, { { 22, 17, 15 }, 2., 4. } }, 1.);
  const SurfaceOptions options = WithIso(50);
  const std::vector<float> bent = attraction.Bend(volume.Image, options, OnThisThread());
  Executor threads(3);
  EXPECT_EQ(bent, attraction.Bend(volume.Image, options, threads));
  int changed = 0;
  std::size_t i = 0;
  ForVoxels({ 33, 33, 33 },
    [&](int x, int y, int z)
    {
      const bool near = Distance(x, y, z, 20, 16, 16) < 4.5 || Distance(x, y, z, 22, 17, 15) < 6.;
      ASSERT_EQ(bent[i] != volume.Values[i], near) << x << ' ' << y << ' ' << z;
      changed += near;
      ++i;
    });
  EXPECT_GT(changed, 900);
}

TEST(EdgeAttraction, PointsToRidgeFromBothSidesAtAnyScale)
{
  for (double scale : { 0.01, 1000. })
  {
    TestVolume volume = MakeVolume(33,
      [scale](double x, double, double) { return scale * std::exp(-0.25 * (x - 16) * (x - 16)); });
    volume.Image.Edges = volume.Values.data();
    const EdgeAttraction edges(volume.Image, OnThisThread());
    const Vector out(1, 0, 0);
    EXPECT_GT(edges.Along(Vector(14.5f, 16, 16), out), 0.9f);
    EXPECT_LT(edges.Along(Vector(17.5f, 16, 16), out), -0.9f);
    EXPECT_GT(edges.Along(Vector(17.5f, 16, 16), Vector(-1, 0, 0)), 0.9f);
    EXPECT_NEAR(edges.Along(Vector(16, 16, 16), out), 0.f, 1e-4f);
    EXPECT_NEAR(edges.Along(Vector(14.5f, 16, 16), Vector(0, 1, 0)), 0.f, 1e-4f);
    EXPECT_NEAR(edges.Along(Vector(5, 16, 16), out), 0.f, 1e-4f);
  }
}

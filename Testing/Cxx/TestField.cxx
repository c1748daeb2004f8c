// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Image/EdgeAttraction.h"
#include "Core/Image/Field.h"
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

TEST(Field, IsTrilinearInComputationalSpace)
{
  TestVolume volume =
    MakeVolume(8, [](double x, double y, double z) { return 1 + x + 2 * y + 3 * z + x * y * z; });
  volume.Image.Step = { 2., 5., 4. };
  const Field field(volume.Image, WithIso(0.), OnThisThread());
  const Vector p(2 * 2.25f, 5 * 3.5f, 4 * 4.75f);
  const double expected = 1 + 2.25 + 7 + 14.25 + 2.25 * 3.5 * 4.75;
  EXPECT_NEAR(field.ValueAt(p), expected, 1e-4);
  const Field::Sample sample = field.At(p);
  EXPECT_NEAR(sample.Value, expected, 1e-4);
  EXPECT_NEAR(sample.Gradient.X, (1 + 3.5 * 4.75) / 2, 1e-4);
  EXPECT_NEAR(sample.Gradient.Y, (2 + 2.25 * 4.75) / 5, 1e-4);
  EXPECT_NEAR(sample.Gradient.Z, (3 + 2.25 * 3.5) / 4, 1e-4);
}

TEST(Field, GradientInterpolatesCentralDifferences)
{
  // The interpolated central difference of x^2 is 2 x; the derivative of the interpolant is not.
  TestVolume volume =
    MakeVolume(10, [](double x, double y, double z) { return x * x + 2 * y * y - z * z; });
  const std::vector<short> shorts(volume.Values.begin(), volume.Values.end());
  const std::vector<double> doubles(volume.Values.begin(), volume.Values.end());
  for (const VoxelValues& values : { volume.Image.Values, VoxelValues(shorts.data(), 1.),
         VoxelValues(shorts.data(), 0.1), VoxelValues(doubles.data(), 0.1) })
  {
    volume.Image.Values = values;
    const Field field(volume.Image, WithIso(0.), OnThisThread());
    const Vector g = field.At(Vector(4.3f, 5.6f, 3.2f)).Gradient;
    EXPECT_NEAR(g.X, 8.6, 1e-4);
    EXPECT_NEAR(g.Y, 22.4, 1e-4);
    EXPECT_NEAR(g.Z, -6.4, 1e-4);
  }
}

TEST(Field, ReachesBackgroundWithinOneVoxelOfBorder)
{
  for (const bool bright : { true, false })
  {
    const TestVolume volume =
      MakeVolume(8, [bright](double, double, double) { return bright ? 10. : 0.; });
    SurfaceOptions options = WithIso(4.);
    options.ObjectIsBright = bright;
    const Field field(volume.Image, options, OnThisThread());
    EXPECT_GT(field.ValueAt(Vector(7, 4, 4)), 0);
    EXPECT_LT(field.ValueAt(Vector(8, 4, 4)), 0);
    EXPECT_LT(field.ValueAt(Vector(4, -1, 4)), 0);
    EXPECT_LT(field.ValueAt(Vector(4, 4, 1000)), 0);
    EXPECT_GT(field.ValueAt(Vector(7, 4, 4)), field.ValueAt(Vector(7.5f, 4, 4)));
    EXPECT_GT(field.ValueAt(Vector(7.5f, 4, 4)), field.ValueAt(Vector(8, 4, 4)));
  }
}

TEST(Field, ReplicatesWithinMarginOfTwoUnits)
{
  // A voxel is longer than the margin along z.
  for (const bool bright : { true, false })
  {
    TestVolume volume = MakeVolume(8, [](double x, double, double) { return x; });
    volume.Image.Step = { 1.5, 1.5, 5. };
    volume.Image.Unit = 1.5;
    SurfaceOptions options = WithIso(3.);
    options.ObjectIsBright = bright;
    options.BorderValue = Border::Replicate;
    const Field field(volume.Image, options, OnThisThread());
    const float x = bright ? 9.f : 1.5f; // in the object
    EXPECT_GT(field.ValueAt(Vector(x, -3.f, 10)), 0);
    EXPECT_LT(field.ValueAt(Vector(x, -3.8f, 10)), 0) << "in the ramp";
    EXPECT_LT(field.ValueAt(Vector(x, 15.f, 10)), field.ValueAt(Vector(x, 14.f, 10)));
    EXPECT_GT(field.ValueAt(Vector(x, 5, 39.9f)), 0);
    EXPECT_LT(field.ValueAt(Vector(x, 5, 40.8f)), 0);
    const float far = field.ValueAt(Vector(x, 1000, 10));
    EXPECT_LE(far, -field.Highest());
    EXPECT_FLOAT_EQ(field.ValueAt(Vector(x, 15.1f, 10)), far);
    EXPECT_FLOAT_EQ(field.At(Vector(x, 15.1f, 10)).Value, far);
    EXPECT_FLOAT_EQ(field.At(Vector(x, 15.1f, 10)).Gradient.Y, 0);
    const float fall = far - field.ValueAt(Vector(x, 10, 10));
    EXPECT_NEAR(field.At(Vector(x, 14.2f, 10)).Gradient.Y, fall / 1.5f, 1e-4f);
  }
}

TEST(Field, IsMinimalOutside)
{
  const TestVolume volume =
    MakeVolume(8, [](double x, double, double) { return x < 4 ? 0. : 100.; });
  for (const double iso : { 99., 50., 1. })
  {
    const Field field(volume.Image, WithIso(iso), OnThisThread());
    const float expected = static_cast<float>(-std::max(iso, 100 - iso));
    EXPECT_FLOAT_EQ(field.ValueAt(Vector(4, 4, 20)), expected);
    EXPECT_FLOAT_EQ(field.ValueAt(Vector(-1, 4, 4)), expected);
    EXPECT_FLOAT_EQ(field.At(Vector(4, -20, 4)).Value, expected);
  }
}

TEST(Field, MeasuresSlopeAtIsosurface)
{
  // Slopes away from the isosurface do not count. Lengths are in computational space.
  for (int axis = 0; axis < 2; ++axis)
  {
    TestVolume volume = MakeVolume(16,
      [axis](double x, double y, double)
      {
        const double t = axis == 0 ? x : y;
        return t < 8 ? 5 * t : (t < 12 ? 40. : 1000 * t);
      });
    volume.Image.Step = { 1., 1., 1. };
    volume.Image.Step[axis] = 2.5;
    const Field field(volume.Image, WithIso(17.), OnThisThread());
    EXPECT_NEAR(field.TypicalSlope(), 2, 1e-4) << "along axis " << axis;
    EXPECT_FLOAT_EQ(field.Lowest(), -17);
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

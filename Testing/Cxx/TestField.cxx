// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/Field.h"
#include "CoreTestTools.h"

using namespace volumic;

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
  const TestVolume volume =
    MakeVolume(10, [](double x, double y, double z) { return x * x + 2 * y * y - z * z; });
  const Field field(volume.Image, WithIso(0.), OnThisThread());
  const Vector g = field.At(Vector(4.3f, 5.6f, 3.2f)).Gradient;
  EXPECT_NEAR(g.X, 8.6, 1e-4);
  EXPECT_NEAR(g.Y, 22.4, 1e-4);
  EXPECT_NEAR(g.Z, -6.4, 1e-4);
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

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
// Forces, measured as velocities after one step from rest, maximum displacement, and smoothing.
#include "DynamicsTestTools.h"

using namespace volumic;

namespace
{
/** Return the speed after a step under a force, in delta per unit of time. */
double SpeedUnder(double force, const SurfaceOptions& options, double step)
{
  return force * step / (1 + options.Friction * step);
}
}

TEST(Forces, IsopotentialSaturatesAtThreeQuartersOfDelta)
{
  for (const double contrast : { 1., 1e4 })
  {
    for (const double distance : { 0.3, -0.3, 0.6, 3. })
    {
      Stage stage(8 + distance);
      for (float& x : stage.Volume.Values)
      {
        x = static_cast<float>((x - 0.5) * contrast);
      }
      stage.Options.IsoValue = 0;
      stage.Options.TensionWeight = 0;
      stage.Options.ElasticityWeight = 0;
      const double step = stage.Push();
      const double force = -std::min(distance / 0.75, 1.);
      EXPECT_NEAR(stage.MeanSpeedOutward(), SpeedUnder(force, stage.Options, step), 0.02)
        << distance;
    }
  }
}

TEST(Forces, IsopotentialIsWeakOnPlateaus)
{
  // The background is slightly below the iso-value.
  Stage stage(12);
  stage.Volume = MakeVolume(
    33, [](double x, double y, double z) { return Distance(x, y, z, 16, 16, 16) < 8 ? 1. : 0.49; });
  const double step = stage.Push();
  // Minimum slope: .15 times the slope of .51 per voxel at the boundary.
  const double force = -0.01 / (0.15 * 0.51 * 0.75);
  EXPECT_NEAR(
    stage.MeanSpeedOutward(), SpeedUnder(force, stage.Options, step), 0.1 * std::abs(force));
}

TEST(Forces, InternalForcesSumToZero)
{
  // Action equals reaction on irregular meshes, too.
  Stage stage(8);
  for (int v : stage.All)
  {
    stage.State.Mesh.Position[v] += Vector(0.1f * (v % 3), 0.07f * (v % 5), -0.05f * (v % 4));
  }
  stage.UpdateShape();
  stage.Options.IsopotentialWeight = 0;
  stage.Options.TensionWeight = 1;
  stage.Options.ElasticityWeight = 1;
  stage.Push();
  VectorD sum;
  double size = 0;
  for (int v : stage.All)
  {
    sum += VectorD(stage.State.Velocity[v]);
    size += Length(stage.State.Velocity[v]);
  }
  EXPECT_GT(size, 1.);
  EXPECT_LT(Length(sum), 1e-4 * size);
}

TEST(Forces, TensionPullsToBarycentreWithReaction)
{
  Stage stage(EvenOctahedron({ 16, 16, 16 }, 1.6), 1);
  stage.Options.TensionWeight = 0.2;
  stage.State.Mesh.Position[0] += Vector(0.5f, 0, 0);
  stage.UpdateShape();
  const double step = stage.Push();
  // Each of four neighbours is pulled by a quarter of the offset; a quarter of this reacts on 0.
  const double pull = -(1.6 / std::sqrt(2.) + 0.5);
  const double force = 0.2 * (pull - 4 * 0.25 * (0.25 * 0.5));
  EXPECT_NEAR(stage.State.Velocity[0].X, SpeedUnder(force, stage.Options, step), 1e-5);
}

TEST(Forces, ElasticityHasRestLengthOfOnePointSixDelta)
{
  for (const float delta : { 1.f, 2.f })
  {
    for (const double length : { 1.2, 1.6, 2.2 })
    {
      Stage stage(EvenOctahedron({ 16, 16, 16 }, length * delta), delta);
      stage.Options.ElasticityWeight = 0.1;
      const double step = stage.Push();
      // Four springs at 45 degrees to the radius.
      const double force = 0.1 * 4 * (1.6 - length) * std::sqrt(0.5);
      EXPECT_NEAR(
        stage.MeanSpeedOutward(), delta * SpeedUnder(force, stage.Options, step), 1e-5 * delta)
        << "edges of " << length << " delta";
    }
  }
}

TEST(Forces, ScaleWithDelta)
{
  // Twice the scale gives twice the velocities.
  Stage fine(10);
  Stage coarse(20, 2);
  coarse.State.Mesh.Position = fine.State.Mesh.Position;
  for (Stage* stage : { &fine, &coarse })
  {
    for (int v : stage->All)
    {
      Vector& p = stage->State.Mesh.Position[v];
      p += Vector(0.1f * (v % 3), 0.07f * (v % 5), -0.05f * (v % 4));
      p *= stage->State.Sizing.OfLevel();
    }
    stage->Volume.Image.Step = { stage->State.Sizing.OfLevel(), stage->State.Sizing.OfLevel(),
      stage->State.Sizing.OfLevel() };
    stage->UpdateShape();
    stage->Push();
  }
  ASSERT_EQ(fine.All.size(), coarse.All.size());
  for (int v : fine.All)
  {
    EXPECT_LT(Length(fine.State.Velocity[v] * 2.f - coarse.State.Velocity[v]), 1e-4);
  }
}

TEST(Forces, GradientForceIsBoundedAndIgnoresIsoValue)
{
  // The potential decreases outward up to radius 12.
  for (const bool bright : { true, false })
  {
    Stage stage(8.3);
    stage.Volume = MakeVolume(33,
      [](double x, double y, double z)
      {
        const double r = Distance(x, y, z, 16, 16, 16);
        return r < 12 ? 1000. - r * r * r : -728.;
      });
    stage.Options.ObjectIsBright = bright;
    stage.Options.IsoValue = 300;
    stage.Options.IsopotentialWeight = 0;
    stage.Options.TensionWeight = 0;
    stage.Options.ElasticityWeight = 0;
    stage.Options.GradientWeight = 0.7;
    const double step = stage.Push();
    EXPECT_NEAR(stage.MeanSpeedOutward(), SpeedUnder(0.7, stage.Options, step), 0.02);
  }
}

TEST(Forces, EdgeAndGradientForcesPointInwardBeyondMargin)
{
  const TestVolume map = MakeVolume(33, [](double x, double, double) { return x < 16 ? 0. : 1.; });
  for (const bool byEdges : { true, false })
  {
    Stage stage(DividedIcosahedron({ 16, 16, 16 }, 22, 1.6), 1);
    stage.Volume.Image.Edges = map.Values.data();
    (byEdges ? stage.Options.EdgeAttractionWeight : stage.Options.GradientWeight) = 0.7;
    const LargeVector<Vector> before = stage.State.Mesh.Position;
    const double step = stage.Push();
    int beyond = 0;
    for (int v : stage.All)
    {
      // The margin ends two units beyond the outermost voxels, its ramp after one more.
      const Vector& p = before[v];
      if (std::min({ p.X, p.Y, p.Z }) < -3.1 || std::max({ p.X, p.Y, p.Z }) > 35.1)
      {
        ++beyond;
        ASSERT_NEAR(Dot(stage.State.Velocity[v], stage.State.Normal[v].Axis()),
          -SpeedUnder(0.7, stage.Options, step), 1e-4)
          << "by edges " << byEdges;
      }
    }
    EXPECT_GT(beyond, 100);
  }
}

TEST(Motion, RespectsMaximumStep)
{
  // Contacts can increase velocities after the step has been chosen.
  for (const double largest : { 0.5, 0.2 })
  {
    Stage stage(12.);
    stage.Options.MaximumStep = largest;
    const Field field(stage.Volume.Image, stage.Options, stage.Threads);
    const Dynamics dynamics(field, stage.Options, stage.Threads);
    Dynamics::Step step;
    dynamics.Accelerate(stage.State, stage.All, {}, step, OnThisThread());
    stage.State.Velocity[3] *= 100.f;
    stage.State.Velocity[4] *= 0.1f;
    const LargeVector<Vector> before = stage.State.Mesh.Position;
    stage.State.PreviousPosition.Fill(Vector());
    dynamics.Displace(stage.State, stage.All, step);
    for (int v : stage.All)
    {
      const Vector motion = stage.State.Mesh.Position[v] - before[v];
      const double speed = Length(stage.State.Velocity[v]);
      EXPECT_NEAR(Length(motion), std::min(speed * static_cast<double>(step.Time), largest), 1e-5);
      EXPECT_GT(Dot(motion, stage.State.Velocity[v]), 0);
      EXPECT_NEAR(stage.State.Displacement[v], Length(motion), 1e-5);
      EXPECT_EQ(Length(stage.State.PreviousPosition[v] - before[v]), 0);
    }
  }
}

TEST(Smoothing, MovesTangentiallyToBarycentre)
{
  Stage stage(8.);
  for (int v : stage.All)
  {
    const Vector shift(0.1f * (v % 3 - 1), 0.07f * (v % 5 - 2), 0.05f * (v % 4 - 1));
    const Vector n = stage.OutwardAt(v);
    stage.State.Mesh.Position[v] += shift - n * Dot(shift, n);
  }
  stage.UpdateShape();
  stage.Relax(false);
  double along = 0;
  for (int v : stage.All)
  {
    const Vector& move = stage.State.Velocity[v];
    const Vector n = stage.State.Normal[v].Axis();
    EXPECT_NEAR(Dot(move, n), 0, 1e-5) << "tangential";
    along += Dot(move, stage.State.Laplacian[v]);
    EXPECT_LE(Length(move), 0.15 + 1e-5) << "small enough to avoid intersections";
  }
  EXPECT_GT(along / static_cast<double>(stage.All.size()), 0.002);
}

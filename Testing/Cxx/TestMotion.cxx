// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Friction, time step, maximum displacement and smoothing.
#include "DynamicsTestTools.h"

using namespace volumic;

TEST(Motion, ReachesTerminalSpeed)
{
  for (const double friction : { 1.5, 3., 8. })
  {
    Stage stage(15.);
    stage.Options.Friction = friction;
    stage.Options.TensionWeight = 0;
    stage.Options.ElasticityWeight = 0;
    // The force is at its bound.
    double step = 0;
    for (int i = 0; i < 10; ++i)
    {
      step = stage.Push();
      stage.UpdateShape();
    }
    EXPECT_NEAR(stage.MeanSpeedOutward(), -1 / friction, 0.02 / friction);
    EXPECT_NEAR(step, 0.5 * friction, 1e-5) << "maximum displacement in a step";
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

namespace
{
/** Sphere of radius 8 with tangentially displaced vertices. */
struct Shaken : Stage
{
  Shaken() : Stage(8.)
  {
    for (int v : this->All)
    {
      const Vector shift(0.1f * (v % 3 - 1), 0.07f * (v % 5 - 2), 0.05f * (v % 4 - 1));
      const Vector n = this->OutwardAt(v);
      this->State.Mesh.Position[v] += shift - n * Dot(shift, n);
    }
    this->UpdateShape();
  }
};
}

TEST(Smoothing, MovesTangentiallyToBarycentre)
{
  Shaken stage;
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

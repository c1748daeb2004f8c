// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CoreTestTools.h"
#include "Dynamics.h"
#include "Executor.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace volumic;

namespace
{
SequentialExecutor Threads;

struct Stage
{
  TestVolume Volume;
  SurfaceOptions Options;
  SurfaceState State;
  std::vector<int> All;

  /** A ball of radius 8 about (16, 16, 16), a sphere of the radius given about the same place. */
  explicit Stage(double radius, float delta = 1)
    : Volume(MakeVolume(33, [](double x, double y, double z)
        { return 8.5 - Distance(x, y, z, 16, 16, 16); }))
  {
    this->Options.IsoValue = 0.5;
    this->State.Mesh.Append(DividedIcosahedron({ 16, 16, 16 }, radius, 1.6 * delta));
    this->State.Delta = delta;
    this->State.Reset(Vector(0, 0, 0), Vector(33, 33, 33));
    this->All.resize(this->State.Mesh.Size());
    std::iota(this->All.begin(), this->All.end(), 0);
    this->State.UpdateShape(this->All, Threads);
  }

  /** Velocities after one step of rest. */
  void Push()
  {
    const Field field(this->Volume.Image, this->Options, Threads);
    Dynamics dynamics(field, this->Options, Threads);
    dynamics.Accelerate(this->State, this->All, {});
    dynamics.Displace(this->State, this->All);
  }

  double MeanSpeedOutward() const
  {
    double sum = 0;
    for (int v : this->All)
    {
      sum += Dot(this->State.Velocity[v],
        Normalized(this->State.Before[v] - Vector(16, 16, 16)));
    }
    return sum / static_cast<double>(this->All.size());
  }
};
}

TEST(Forces, IsopotentialPushesInFromOutsideAndOutFromInside)
{
  Stage outside(12);
  outside.Push();
  EXPECT_LT(outside.MeanSpeedOutward(), -0.1);
  Stage inside(5);
  inside.Push();
  EXPECT_GT(inside.MeanSpeedOutward(), 0.1);
}

TEST(Forces, IsopotentialTurnsRoundForDarkObjects)
{
  Stage stage(12);
  stage.Options.ObjectIsBright = false;
  stage.Push();
  EXPECT_GT(stage.MeanSpeedOutward(), 0.1);
}

TEST(Forces, IsopotentialVanishesOnTheIsopotential)
{
  Stage stage(8);
  stage.Options.TensionWeight = 0;
  stage.Options.ElasticityWeight = 0;
  stage.Push();
  EXPECT_NEAR(stage.MeanSpeedOutward(), 0, 0.03);
}

TEST(Forces, IsopotentialIsBounded)
{
  for (const double contrast : { 1., 1e4 })
  {
    Stage stage(12);
    for (float& x : stage.Volume.Values)
    {
      x = static_cast<float>((x - 0.5) * contrast);
    }
    stage.Options.IsoValue = 0;
    stage.Push();
    EXPECT_GE(stage.MeanSpeedOutward(), -1. / stage.Options.Friction - 1e-3);
  }
}

TEST(Forces, NoVertexGoesFurtherThanTheLargestStep)
{
  Stage stage(12);
  stage.Options.IsopotentialWeight = 50;
  stage.Push();
  for (int v : stage.All)
  {
    EXPECT_LE(Length(stage.State.Mesh.Position[v] - stage.State.Before[v]), 0.5 + 1e-4);
  }
}

TEST(Forces, InternalForcesAddUpToNothing)
{
  // Action and reaction: also on an uneven mesh the whole is not pushed anywhere.
  Stage stage(8);
  for (int v : stage.All)
  {
    stage.State.Mesh.Position[v] += Vector(0.1f * (v % 3), 0.07f * (v % 5), -0.05f * (v % 4));
  }
  stage.State.UpdateShape(stage.All, Threads);
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

TEST(Forces, TensionPullsAnOutlierBack)
{
  Stage stage(8);
  stage.Options.IsopotentialWeight = 0;
  stage.Options.ElasticityWeight = 0;
  const Vector outward = Normalized(stage.State.Mesh.Position[0] - Vector(16, 16, 16));
  stage.State.Mesh.Position[0] += outward;
  stage.State.UpdateShape(stage.All, Threads);
  stage.Push();
  EXPECT_LT(Dot(stage.State.Velocity[0], outward), 0);
}

TEST(Forces, GradientForceDescendsThePotential)
{
  // The image is a potential with its valley at radius 8.
  for (const double radius : { 7.2, 8.8 })
  {
    Stage stage(radius);
    stage.Volume = MakeVolume(33, [](double x, double y, double z)
      { return std::abs(Distance(x, y, z, 16, 16, 16) - 8.); });
    stage.Options.IsoValue = 1;
    stage.Options.IsopotentialWeight = 0;
    stage.Options.GradientWeight = 1;
    stage.Push();
    if (radius < 8)
    {
      EXPECT_GT(stage.MeanSpeedOutward(), 0.05);
    }
    else
    {
      EXPECT_LT(stage.MeanSpeedOutward(), -0.05);
    }
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// The displacements at the end of a level: along the surface, and onto what is searched.
#include "DynamicsTestTools.h"

using namespace volumic;

namespace
{
/** A sphere of radius 8 whose vertices have been moved along it. */
struct Shaken : Stage
{
  Shaken()
    : Stage(8.)
  {
    for (int v : this->All)
    {
      const Vector way(0.1f * (v % 3 - 1), 0.07f * (v % 5 - 2), 0.05f * (v % 4 - 1));
      const Vector n = this->OutwardAt(v);
      this->State.Mesh.Position[v] += way - n * Dot(way, n);
    }
    this->UpdateShape();
  }
};
}

TEST(Smoothing, GoesAlongTheSurfaceToTheBarycentre)
{
  Shaken stage;
  stage.Relax(false);
  double along = 0;
  for (int v : stage.All)
  {
    const Vector& move = stage.State.Velocity[v];
    const Vector n = stage.State.Normal[v].Axis();
    EXPECT_NEAR(Dot(move, n), 0, 1e-5) << "it would shrink";
    along += Dot(move, stage.State.Laplacian[v]);
    EXPECT_LE(Length(move), 0.15 + 1e-5) << "little enough to stay free of intersections";
  }
  EXPECT_GT(along / static_cast<double>(stage.All.size()), 0.002);
}

TEST(Smoothing, IsBounded)
{
  Stage stage(8.);
  stage.State.Mesh.Position[0] += Vector(0, 0, 2.5f);
  stage.State.Mesh.Position[5] += Vector(2.5f, 0, 0);
  stage.UpdateShape();
  stage.Relax(true);
  EXPECT_NEAR(stage.FastestSpeed(), 0.15, 1e-5);
}

TEST(Smoothing, LeadsOntoTheIsopotentialOnRequest)
{
  for (const double way : { -0.1, 0.1, 1. })
  {
    Stage stage(8 + way);
    stage.Relax(true);
    const double step = -std::min(way, 0.15);
    EXPECT_NEAR(stage.MeanSpeedOutward(), step, 0.02);
    stage.Relax(false);
    EXPECT_NEAR(stage.MeanSpeedOutward(), 0, 0.005);
  }
}

TEST(Smoothing, LeavesVerticesWhoseNormalIsNotThatOfTheImage)
{
  // The field falls along x: for most of the sphere a step along the normal leads far astray.
  Stage stage(8.);
  stage.Volume = MakeVolume(33, [](double x, double, double) { return 20 - x; });
  stage.Relax(true);
  for (int v : stage.All)
  {
    const double cosine = stage.OutwardAt(v).X;
    if (std::abs(cosine - 0.5) > 0.05)
    {
      const bool led = std::abs(Dot(stage.State.Velocity[v], stage.OutwardAt(v))) > 0.05;
      EXPECT_EQ(led, cosine > 0.5) << cosine;
    }
  }
}

TEST(Smoothing, LeavesVerticesWhereTheImageIsFlat)
{
  // A twentieth of the slope that boundaries have.
  Stage stage(8.);
  stage.Volume = MakeVolume(33,
    [](double x, double y, double z)
    {
      const double r = Distance(x, y, z, 16, 16, 16);
      return r < 12 ? 20. - 0.05 * r : 0.;
    });
  stage.Options.IsoValue = 10;
  stage.Relax(true);
  EXPECT_NEAR(stage.MeanSpeedOutward(), 0, 0.005);
}

TEST(Smoothing, LeadsOntoTheEdgesOnRequest)
{
  const TestVolume map = MakeVolume(33,
    [](double x, double y, double z)
    {
      const double way = Distance(x, y, z, 16, 16, 16) - 8;
      return std::exp(-0.5 * way * way);
    });
  for (const double radius : { 7.2, 8.8 })
  {
    for (const bool snap : { true, false })
    {
      Stage stage(radius);
      stage.Volume.Image.Edges = map.Values.data();
      stage.Options.EdgeAttractionWeight = 1;
      stage.Options.SnapToEdges = snap;
      stage.Relax(false);
      EXPECT_NEAR(stage.MeanSpeedOutward(), snap ? (radius < 8 ? 0.14 : -0.14) : 0, 0.03);
    }
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Contacts stop what comes near, whether forces or the final smoothing move it.
#include "DynamicsTestTools.h"

using namespace volumic;

namespace
{
/** Two octahedra of radius 1.2 whose tips face each other along x. */
struct Facing : Stage
{
  explicit Facing(double gap) : Stage(Surface(gap), 1) {}

  static IndexedSurface Surface(double gap)
  {
    const double r = 1.2;
    IndexedSurface surface;
    for (const double x : { 10., 10. + 2 * r + gap })
    {
      const int n = static_cast<int>(surface.Points.size());
      for (const Point& p :
        { Point{ x + r, 16, 16 }, Point{ x - r, 16, 16 }, Point{ x, 16 + r, 16 },
          Point{ x, 16 - r, 16 }, Point{ x, 16, 16 + r }, Point{ x, 16, 16 - r } })
      {
        surface.Points.push_back(p);
      }
      for (const Triangle& t :
        { Triangle{ 0, 2, 4 }, Triangle{ 2, 1, 4 }, Triangle{ 1, 3, 4 }, Triangle{ 3, 0, 4 },
          Triangle{ 2, 0, 5 }, Triangle{ 1, 2, 5 }, Triangle{ 3, 1, 5 }, Triangle{ 0, 3, 5 } })
      {
        surface.Triangles.push_back({ t[0] + n, t[1] + n, t[2] + n });
      }
    }
    return surface;
  }

  static constexpr int Left = 0;      ///< The tip of the left one.
  static constexpr int Right = 6 + 1; ///< The tip that it faces.

  /** Both sides of the pair, as an examination lists it. */
  std::vector<Proximity::ClosePair> Pairs() const
  {
    const float squared =
      SquaredDistance(this->State.Mesh.Position[Left], this->State.Mesh.Position[Right]);
    return { { Left, Right, squared }, { Right, Left, squared } };
  }
};
}

TEST(Contact, StopsWhatComesNear)
{
  Facing stage(1.2);
  stage.State.Velocity[Facing::Left] = Vector(0.2f, 0.1f, 0);
  stage.State.Velocity[Facing::Right] = Vector(-0.2f, 0, 0);
  stage.Push(stage.Pairs());
  EXPECT_NEAR(stage.State.Velocity[Facing::Left].X, 0, 1e-5);
  EXPECT_NEAR(stage.State.Velocity[Facing::Right].X, 0, 1e-5);
  EXPECT_GT(stage.State.Velocity[Facing::Left].Y, 0.01) << "sliding by is allowed";
}

TEST(Contact, IsNotElastic)
{
  // The faster one pushes the slower one along: both go on together.
  Facing stage(1.2);
  stage.State.Velocity[Facing::Left] = Vector(0.2f, 0, 0);
  stage.Push(stage.Pairs());
  const float left = stage.State.Velocity[Facing::Left].X;
  EXPECT_GT(left, 0.01);
  EXPECT_NEAR(stage.State.Velocity[Facing::Right].X, left, 1e-5);
}

TEST(Contact, AtAFrozenVertexStopsAltogether)
{
  Facing stage(1.2);
  stage.State.Velocity[Facing::Left] = Vector(0.2f, 0, 0);
  stage.State.Active[Facing::Right] = 0;
  stage.All.erase(stage.All.begin() + Facing::Right);
  stage.Push(stage.Pairs());
  EXPECT_NEAR(stage.State.Velocity[Facing::Left].X, 0, 1e-5);
  EXPECT_EQ(Length(stage.State.Velocity[Facing::Right]), 0);
}

TEST(Contact, LetsGoWhatDepartsAndWhatIsFar)
{
  Facing departing(1.2);
  departing.State.Velocity[Facing::Left] = Vector(-0.2f, 0, 0);
  departing.Push(departing.Pairs());
  EXPECT_LT(departing.State.Velocity[Facing::Left].X, -0.015);
  EXPECT_NEAR(departing.State.Velocity[Facing::Right].X, 0, 1e-6);
  // Pairs are found a little beyond lambda delta = 1.443.
  Facing far(1.5);
  far.State.Velocity[Facing::Left] = Vector(0.2f, 0, 0);
  far.Push(far.Pairs());
  EXPECT_GT(far.State.Velocity[Facing::Left].X, 0.015);
  EXPECT_NEAR(far.State.Velocity[Facing::Right].X, 0, 1e-6);
}

TEST(Contact, PushesApartWhatIsNearerThanDelta)
{
  Facing stage(0.6);
  const double step = stage.Push(stage.Pairs());
  const Vector way =
    stage.State.Mesh.Position[Facing::Right] - stage.State.Mesh.Position[Facing::Left];
  // Each by a quarter of what is missing.
  EXPECT_NEAR(Length(way), 0.6 + 2 * 0.25 * 0.4, 1e-4) << "step " << step;
}

TEST(Contact, StopsSmoothingToo)
{
  // The tip of the left one is drawn back by its neighbours, the right one is held by its own.
  for (const bool contact : { false, true })
  {
    Facing stage(1.2);
    stage.Volume = MakeVolume(33, [](double x, double, double) { return 20. - x; });
    stage.Options.IsoValue = 0; // Both sides are led to x = 20, far to the right.
    stage.UpdateShape();
    stage.State.Active[Facing::Right] = 0;
    stage.All.erase(stage.All.begin() + Facing::Right);
    stage.Relax(true, contact ? stage.Pairs() : std::vector<Proximity::ClosePair>());
    if (contact)
    {
      EXPECT_NEAR(stage.State.Velocity[Facing::Left].X, 0, 1e-5);
    }
    else
    {
      EXPECT_GT(stage.State.Velocity[Facing::Left].X, 0.1);
    }
  }
}

namespace
{
/** A torus of small hole, or thin waist, through the place; `value` is what the image says there.
 */
float SpeedAcross(bool hole, double value)
{
  // Two opposite vertices of a waist of four; inward normals make a hole of it.
  IndexedSurface surface = MakeTorus({ 16, 16, 16 }, 6, 0.7, 24, 4);
  if (hole)
  {
    for (Triangle& t : surface.Triangles)
    {
      std::swap(t[1], t[2]);
    }
  }
  Stage stage(surface, 1);
  stage.Volume = MakeVolume(33, [value](double, double, double) { return value; });
  const int v = 0; // Outermost of the first ring of four; 2 is the innermost.
  const int w = 2;
  const Vector across = stage.State.Mesh.Position[w] - stage.State.Mesh.Position[v];
  const float squared = SquaredLength(across);
  stage.State.Velocity[v] = Normalized(across) * 0.2f;
  stage.State.Velocity[w] = Normalized(across) * -0.2f;
  stage.Push({ { v, w, squared }, { w, v, squared } });
  return Dot(stage.State.Velocity[v], Normalized(across));
}
}

TEST(Contact, LetsHolesAndWaistsCloseWhereTheImageWantsIt)
{
  // Two vertices with a common neighbour: short of the cycle of three that a cut needs.
  EXPECT_GT(SpeedAcross(true, 1.), 0.015) << "a hole in the object";
  EXPECT_NEAR(SpeedAcross(true, -1.), 0, 1e-4) << "a hole in the background";
  EXPECT_GT(SpeedAcross(false, -1.), 0.015) << "a waist in the background";
  EXPECT_NEAR(SpeedAcross(false, 1.), 0, 1e-4) << "a waist in the object";
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
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
    IndexedSurface surface = Octahedron({ 10, 16, 16 }, r, r, r);
    AddSurface(surface, Octahedron({ 10 + 2 * r + gap, 16, 16 }, r, r, r));
    return surface;
  }

  static constexpr int Left = 0;      ///< tip of the left octahedron
  static constexpr int Right = 6 + 1; ///< facing tip of the right octahedron

  /** Return the pair as the proximity test lists it. */
  std::vector<Proximity::ClosePair> Pairs() const
  {
    const float squared =
      SquaredDistance(this->State.Mesh.Position[Left], this->State.Mesh.Position[Right]);
    return { { Left, Right, squared }, { Right, Left, squared } };
  }
};
}

TEST(Contact, StopsApproachingVertices)
{
  Facing stage(1.2);
  stage.State.Velocity[Facing::Left] = Vector(0.2f, 0.1f, 0);
  stage.State.Velocity[Facing::Right] = Vector(-0.2f, 0, 0);
  stage.Push(stage.Pairs());
  EXPECT_NEAR(stage.State.Velocity[Facing::Left].X, 0, 1e-5);
  EXPECT_NEAR(stage.State.Velocity[Facing::Right].X, 0, 1e-5);
  EXPECT_GT(stage.State.Velocity[Facing::Left].Y, 0.01) << "tangential motion is allowed";
}

TEST(Contact, StopsAtFrozenVertex)
{
  Facing stage(1.2);
  stage.State.Velocity[Facing::Left] = Vector(0.2f, 0, 0);
  stage.State.Active[Facing::Right] = 0;
  stage.All.erase(stage.All.begin() + Facing::Right);
  stage.Push(stage.Pairs());
  EXPECT_NEAR(stage.State.Velocity[Facing::Left].X, 0, 1e-5);
  EXPECT_EQ(Length(stage.State.Velocity[Facing::Right]), 0);
}

TEST(Contact, IgnoresDepartingAndDistantVertices)
{
  Facing departing(1.2);
  departing.State.Velocity[Facing::Left] = Vector(-0.2f, 0, 0);
  departing.Push(departing.Pairs());
  EXPECT_LT(departing.State.Velocity[Facing::Left].X, -0.015);
  EXPECT_NEAR(departing.State.Velocity[Facing::Right].X, 0, 1e-6);
  // The proximity test lists pairs slightly beyond lambda delta = 1.443.
  Facing far(1.5);
  far.State.Velocity[Facing::Left] = Vector(0.2f, 0, 0);
  far.Push(far.Pairs());
  EXPECT_GT(far.State.Velocity[Facing::Left].X, 0.015);
  EXPECT_NEAR(far.State.Velocity[Facing::Right].X, 0, 1e-6);
}

TEST(Contact, SeparatesVerticesCloserThanDelta)
{
  Facing stage(0.6);
  const double step = stage.Push(stage.Pairs());
  const Vector gap =
    stage.State.Mesh.Position[Facing::Right] - stage.State.Mesh.Position[Facing::Left];
  // Each vertex moves by a quarter of the missing distance.
  EXPECT_NEAR(Length(gap), 0.6 + 2 * 0.25 * 0.4, 1e-4) << "step " << step;
}

TEST(Contact, StopsSmoothing)
{
  for (const bool contact : { false, true })
  {
    Facing stage(1.2);
    stage.Volume = MakeVolume(33, [](double x, double, double) { return 20. - x; });
    stage.Options.IsoValue = 0; // isosurface x = 20, far to the right
    stage.UpdateShape();
    stage.State.Active[Facing::Right] = 0;
    stage.All.erase(stage.All.begin() + Facing::Right);
    stage.Relax(true, contact ? stage.Pairs() : std::vector<Proximity::ClosePair>());
    const float speed = stage.State.Velocity[Facing::Left].X;
    EXPECT_TRUE(contact ? std::abs(speed) < 1e-5f : speed > 0.1f) << speed;
  }
}

namespace
{
/** Return the approaching speed of opposite vertices of a small hole or waist. */
float SpeedAcross(bool hole, double value)
{
  // Opposite vertices of a cycle of four. Inverted orientation turns the waist into a hole.
  const IndexedSurface waist = MakeTorus({ 16, 16, 16 }, 6, 0.7, 24, 4);
  Stage stage(hole ? InsideOut(waist) : waist, 1);
  stage.Volume = MakeVolume(33, [value](double, double, double) { return value; });
  const int v = 0; // outermost vertex of the first cycle; 2 is the innermost
  const int w = 2;
  const Vector across = stage.State.Mesh.Position[w] - stage.State.Mesh.Position[v];
  const float squared = SquaredLength(across);
  stage.State.Velocity[v] = Normalized(across) * 0.2f;
  stage.State.Velocity[w] = Normalized(across) * -0.2f;
  stage.Push({ { v, w, squared }, { w, v, squared } });
  return Dot(stage.State.Velocity[v], Normalized(across));
}
}

TEST(Contact, LetsHolesCloseInObjectAndWaistsInBackground)
{
  // The vertices have a common neighbour. A cut needs a cycle of three.
  EXPECT_GT(SpeedAcross(true, 1.), 0.015) << "a hole in the object";
  EXPECT_NEAR(SpeedAcross(true, -1.), 0, 1e-4) << "a hole in the background";
  EXPECT_GT(SpeedAcross(false, -1.), 0.015) << "a waist in the background";
  EXPECT_NEAR(SpeedAcross(false, 1.), 0, 1e-4) << "a waist in the object";
}

namespace
{
/** Sphere with one vertex that the tests move. */
class Freezing : public ::testing::Test
{
protected:
  Freezing()
    : Actors(DividedIcosahedron({ 16, 16, 16 }, 8, 1.6), 1),
      TheField(this->Actors.Volume.Image, this->Actors.Options, this->Actors.Threads),
      Motion(this->TheField, this->Actors.Options, this->Actors.Threads),
      Neighbour(this->Actors.State.Mesh.Rings[Mover].Item[0])
  {
  }

  bool IsActive(int v) const { return this->Actors.State.Active[v] != 0; }
  int CountActive() const
  {
    const auto& active = this->Actors.State.Active.AsVector();
    return static_cast<int>(std::count_if(active.begin(), active.end(), [](int x) { return x; }));
  }

  /** Run an iteration in which the vertex Mover moves. */
  void Iterate(const Vector& displacement = Vector())
  {
    SurfaceState& s = this->Actors.State;
    std::vector<int> active;
    for (int v : this->Actors.All)
    {
      if (s.Active[v])
      {
        active.push_back(v);
        s.PreviousPosition[v] = s.Mesh.Position[v];
      }
    }
    s.MoveTo(Mover, s.Mesh.Position[Mover] + displacement);
    this->Motion.Freeze(s, active, this->Actors.All);
  }

  static constexpr int Mover = 30;
  Stage Actors;
  Field TheField;
  Dynamics Motion;
  int Neighbour;
};
}

TEST_F(Freezing, FreezesAfterThreeMotionlessIterations)
{
  this->Actors.State.Velocity[7] = Vector(0.1f, 0, 0);
  for (int i = 0; i < 2; ++i)
  {
    this->Iterate();
    EXPECT_EQ(this->CountActive(), static_cast<int>(this->Actors.All.size())) << i;
  }
  this->Iterate();
  EXPECT_EQ(this->CountActive(), 0);
  EXPECT_EQ(Length(this->Actors.State.Velocity[7]), 0) << "motionless vertices have no velocity";
}

TEST_F(Freezing, KeepsMovingVertexAndNeighboursActive)
{
  // Steps of delta / 100 accumulate.
  for (int i = 0; i < 20; ++i)
  {
    this->Iterate(this->Actors.OutwardAt(Mover) * 0.01f);
  }
  EXPECT_TRUE(this->IsActive(Mover));
  for (int w : this->Actors.All)
  {
    EXPECT_EQ(this->IsActive(w), w == Mover || this->Actors.State.Mesh.AreNeighbours(Mover, w));
  }
}

TEST_F(Freezing, MotionActivatesMotionlessNeighbours)
{
  for (int i = 0; i < 3; ++i)
  {
    this->Iterate();
  }
  ASSERT_FALSE(this->IsActive(this->Neighbour));
  this->Actors.State.Active[Mover] = 1;
  this->Iterate(this->Actors.OutwardAt(Mover) * 0.05f);
  EXPECT_TRUE(this->IsActive(this->Neighbour));
  EXPECT_EQ(this->CountActive(), 1 + this->Actors.State.Mesh.Rings[Mover].Count);
  for (int i = 0; i < 2; ++i)
  {
    this->Iterate();
    EXPECT_TRUE(this->IsActive(this->Neighbour)) << "the count of motionless iterations restarts";
  }
}

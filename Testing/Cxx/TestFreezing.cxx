// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Vertices at rest are skipped until something near them changes.
#include "Core/Surface/SurfaceEditor.h"
#include "DynamicsTestTools.h"

using namespace volumic;

namespace
{
/** A sphere whose vertices the tests move by hand, which become motionless when they do not. */
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

  /** An iteration in which one vertex is moved by some way along a direction. */
  void Iterate(const Vector& way = Vector())
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
    s.MoveTo(Mover, s.Mesh.Position[Mover] + way);
    this->Motion.Freeze(s, active, this->Actors.All);
  }

  static constexpr int Mover = 30;
  Stage Actors;
  Field TheField;
  Dynamics Motion;
  int Neighbour;
};
}

TEST_F(Freezing, TakesThreeIterationsOfRest)
{
  this->Actors.State.Velocity[7] = Vector(0.1f, 0, 0);
  for (int i = 0; i < 2; ++i)
  {
    this->Iterate();
    EXPECT_EQ(this->CountActive(), static_cast<int>(this->Actors.All.size())) << i;
  }
  this->Iterate();
  EXPECT_EQ(this->CountActive(), 0);
  EXPECT_EQ(Length(this->Actors.State.Velocity[7]), 0) << "what is motionless has no velocity";
}

TEST_F(Freezing, IsLeftOutOnRequest)
{
  this->Actors.Options.FreezeMotionlessVertices = false;
  for (int i = 0; i < 10; ++i)
  {
    this->Iterate();
  }
  EXPECT_EQ(this->CountActive(), static_cast<int>(this->Actors.All.size()));
}

TEST_F(Freezing, LeavesWhatMovesAndItsNeighboursActive)
{
  for (int i = 0; i < 10; ++i)
  {
    this->Iterate(this->Actors.OutwardAt(Mover) * 0.05f);
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
    EXPECT_TRUE(this->IsActive(this->Neighbour)) << "its patience starts afresh";
  }
}

TEST_F(Freezing, SlowMotionIsMotion)
{
  // A hundredth of delta is not visible at once, but it adds up.
  for (int i = 0; i < 20; ++i)
  {
    this->Iterate(this->Actors.OutwardAt(Mover) * 0.01f);
  }
  EXPECT_TRUE(this->IsActive(Mover));
}

TEST_F(Freezing, OneMotionDoesNotKeepAVertexActiveForEver)
{
  this->Iterate(this->Actors.OutwardAt(Mover) * 0.2f);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_TRUE(this->IsActive(Mover));
    this->Iterate();
  }
  EXPECT_FALSE(this->IsActive(Mover));
}

TEST_F(Freezing, SlidingAlongTheSurfaceCountsOnlyWhenItLeadsFar)
{
  const Vector along = Normalized(Cross(this->Actors.OutwardAt(Mover), Vector(1, 0, 0)));
  Stage& stage = this->Actors;
  const Vector start = stage.State.Mesh.Position[Mover];
  for (int i = 0; i < 6; ++i)
  {
    this->Iterate(along * (i % 2 == 0 ? 0.1f : -0.1f));
  }
  EXPECT_FALSE(this->IsActive(Mover)) << "to and fro";
  ASSERT_LT(Length(stage.State.Mesh.Position[Mover] - start), 1e-5);
  stage.State.Active[Mover] = 1;
  this->Iterate(along * 0.4f);
  EXPECT_TRUE(this->IsActive(this->Neighbour));
}

TEST_F(Freezing, EditsActivate)
{
  for (int i = 0; i < 5; ++i)
  {
    this->Iterate();
  }
  ASSERT_FALSE(this->IsActive(Mover));
  const Vector place = this->Actors.State.Mesh.Position[Mover];
  SurfaceEditor editor(this->Actors.State);
  ASSERT_TRUE(editor.Move(Mover, place * 1.001f, EditTolerance::Smooth));
  EXPECT_TRUE(this->IsActive(Mover));
  EXPECT_TRUE(this->IsActive(this->Neighbour));
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Rejection of edits: illegal lengths, slivers, flipped faces and intersections.
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Mesh/EdgeSplit.h"
#include "Core/Surface/Proximity.h"
#include "Core/Surface/SurfaceEditor.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
/** A sphere, optionally with a small obstacle. */
struct Workbench : Bench
{
  explicit Workbench(double edge)
    : Bench(DividedIcosahedron({ 0, 0, 0 }, 10.2, edge)), Editor(this->State)
  {
  }

  /** Append a small octahedron. */
  void Obstruct(const Vector& position, double size)
  {
    const int first =
      this->State.Mesh.Append(Octahedron({ position.X, position.Y, position.Z }, size, size, size));
    for (int v = first; v < this->State.Mesh.Size(); ++v)
    {
      this->State.AddVertex(v, V);
    }
    this->State.EulerCharacteristic += 2;
    this->UpdateShape();
    ASSERT_TRUE(this->IsSound());
  }

  const Vector& At(int v) const { return this->State.Mesh.Position[v]; }
  Vector Outward(int v) const { return Normalized(this->At(v)); }

  static constexpr int V = 40;
  int W = this->State.Mesh.Rings[V].Item[0];
  SurfaceEditor Editor;
};

constexpr double Fine = 1.3;   ///< Edge lengths from 1.1 to 1.25.
constexpr double Coarse = 2.2; ///< About 2.
}

TEST(SurfaceEditor, SplitInterpolatesPositionAndMotion)
{
  Workbench bench(Coarse);
  SurfaceState& s = bench.State;
  s.Velocity[bench.V] = Vector(1, 0, 0);
  s.Velocity[bench.W] = Vector(0, 3, 0);
  s.PreviousPosition[bench.V] = Vector(1, 2, 3);
  s.PreviousPosition[bench.W] = Vector(3, 2, 1);
  s.Marks[bench.V] = s.Marks[bench.W] = IsWorking;
  const Vector middle = (bench.At(bench.V) + bench.At(bench.W)) * 0.5f;
  const int m = bench.Editor.Split(bench.V, bench.W).Vertex;
  ASSERT_GE(m, 0);
  EXPECT_LT(Length(bench.At(m) - middle), 1e-6);
  EXPECT_LT(Length(s.Velocity[m] - Vector(0.5f, 1.5f, 0)), 1e-6);
  EXPECT_LT(Length(s.PreviousPosition[m] - Vector(2, 2, 2)), 1e-6) << "a rollback moves it there";
}

TEST(SurfaceEditor, CollapseLimitsFaceRotation)
{
  for (const float height : { 0.15f, 1.1f })
  {
    Workbench bench(0.7); // Far below the longest legal edge.
    const Vector middle = (bench.At(bench.V) + bench.At(bench.W)) * 0.5f;
    const Vector spike = middle + bench.Outward(bench.V) * height;
    EXPECT_EQ(bench.Editor.CollapseTo(bench.V, bench.W, spike, EditTolerance::Smooth).IsDone,
      height < 0.5f);
    EXPECT_TRUE(bench.IsSound());
  }
}

TEST(SurfaceEditor, CollapseAndMoveAvoidIntersections)
{
  for (const bool obstructed : { false, true })
  {
    for (const bool collapse : { false, true })
    {
      for (const EditTolerance tolerance : { EditTolerance::Smooth, EditTolerance::Loose })
      {
        Workbench bench(Fine);
        const Vector start =
          collapse ? (bench.At(bench.V) + bench.At(bench.W)) * 0.5f : bench.At(bench.V);
        const Vector position = start + bench.Outward(bench.V) * 0.3f;
        if (obstructed)
        {
          bench.Obstruct(start + bench.Outward(bench.V) * 0.5f, 0.3);
        }
        EXPECT_EQ(collapse ? bench.Editor.CollapseTo(bench.V, bench.W, position, tolerance).IsDone
                           : bench.Editor.Move(bench.V, position, tolerance).IsDone,
          !obstructed);
        EXPECT_TRUE(bench.IsSound());
      }
    }
  }
}

TEST(SurfaceEditor, FlipAvoidsIntersections)
{
  // The new edge is deeper in the ball than the old one, where the obstacle is.
  for (const bool obstructed : { false, true })
  {
    for (const EditTolerance tolerance : { EditTolerance::Smooth, EditTolerance::Loose })
    {
      Workbench bench(Fine);
      const EdgeFlip flip = EdgeFlip::Of(bench.State.Mesh, bench.V, bench.W);
      const Vector before = (bench.At(flip.U) + bench.At(flip.V)) * 0.5f;
      const Vector after = (bench.At(flip.A) + bench.At(flip.B)) * 0.5f;
      ASSERT_GT(Length(before), Length(after) + 0.02f);
      if (obstructed)
      {
        bench.Obstruct(after, 0.01);
      }
      EXPECT_EQ(bench.Editor.Flip(bench.V, bench.W, tolerance).IsDone, !obstructed);
      EXPECT_TRUE(bench.IsSound());
    }
  }
}

TEST(SurfaceEditor, RemovalAvoidsIntersections)
{
  // A vertex of valence 3 above a face, with an obstacle between them.
  for (const bool obstructed : { false, true })
  {
    Workbench bench(Coarse);
    SurfaceMesh& mesh = bench.State.Mesh;
    const int m = EdgeSplit{ bench.V, bench.W }.Apply(mesh, Vector());
    EdgeFlip::Of(mesh, m, bench.V).Apply(mesh);
    ASSERT_EQ(mesh.Rings[m].Count, 3);
    const Ring ring = mesh.Rings[m];
    const Vector floor =
      (bench.At(ring.Item[0]) + bench.At(ring.Item[1]) + bench.At(ring.Item[2])) * (1.f / 3);
    mesh.Position[m] = floor + Normalized(floor) * 1.5f;
    bench.State.AddVertex(m, bench.V);
    bench.UpdateShape();
    if (obstructed)
    {
      bench.Obstruct(floor, 0.2);
    }
    EXPECT_EQ(bench.Editor.Remove(m).IsDone, !obstructed);
    EXPECT_TRUE(bench.IsSound());
  }
}

TEST(SurfaceEditor, MoveLimitsEdgeLengthAndFaceRotation)
{
  Workbench coarse(Coarse);
  const Vector p = coarse.At(coarse.V);
  const Vector along = Normalized(p - coarse.At(coarse.W));
  EXPECT_TRUE(coarse.Editor.Move(coarse.V, p + along * 0.03f, EditTolerance::Smooth));
  EXPECT_FALSE(coarse.Editor.Move(coarse.V, p + along * 0.8f, EditTolerance::Smooth))
    << "edge length 2.7";
  for (const EditTolerance tolerance : { EditTolerance::Smooth, EditTolerance::Loose })
  {
    Workbench bench(Fine);
    const Vector spike = bench.At(bench.V) + bench.Outward(bench.V) * 1.4f;
    EXPECT_EQ(
      bench.Editor.Move(bench.V, spike, tolerance).IsDone, tolerance == EditTolerance::Loose);
    EXPECT_TRUE(bench.IsSound());
  }
}

TEST(SurfaceEditor, MergeLimitsBridgeEdgesAndAvoidsIntersections)
{
  const auto merged = [](double gap, bool obstructed)
  {
    // Two squares that face each other along x.
    IndexedSurface surface = Octahedron({ -1 - gap / 2, 0, 0 }, 1, 1, 1);
    AddSurface(surface, Octahedron({ 1 + gap / 2, 0, 0 }, 1, 1, 1));
    if (obstructed)
    {
      // A thin plate in the gap that extends beyond the links.
      AddSurface(surface, Octahedron({ 0, 0, 0 }, 0.1, 3, 3));
    }
    Bench bench(surface);
    const bool done = SurfaceEditor(bench.State).Merge(0, 6 + 1).IsDone;
    EXPECT_TRUE(bench.IsSound());
    EXPECT_EQ(bench.State.EulerCharacteristic, (obstructed ? 6 : 4) - (done ? 2 : 0));
    return done;
  };
  EXPECT_TRUE(merged(0.5, false));
  EXPECT_FALSE(merged(0.5, true));
  EXPECT_TRUE(merged(1.5, false)) << "bridge edge length 3.5";
  EXPECT_FALSE(merged(3, false)) << "bridge edge length 5";
}

TEST(SurfaceEditor, CutSeparatesBothSides)
{
  Bench bench(MakeTorus({ 0, 0, 0 }, 5, 0.5, 18, 3));
  ASSERT_TRUE(SurfaceEditor(bench.State).Cut(0, 1, 2));
  EXPECT_EQ(bench.State.EulerCharacteristic, 2);
  EXPECT_TRUE(bench.IsSound());
}

TEST(SurfaceEditor, RejectedCutRestoresSurface)
{
  // A needle along the tube, at the position of the two caps.
  IndexedSurface surface = MakeTorus({ 0, 0, 0 }, 5, 0.5, 18, 3);
  AddSurface(surface, Octahedron({ 5, 0, 0 }, 0.05, 0.8, 0.05));
  Bench bench(surface);
  ASSERT_TRUE(bench.IsSound());
  const SurfaceMesh before = bench.State.Mesh;
  EXPECT_FALSE(SurfaceEditor(bench.State).Cut(0, 1, 2));
  EXPECT_TRUE(bench.IsSound());
  EXPECT_EQ(bench.State.EulerCharacteristic, 2);
  EXPECT_EQ(bench.State.Counts.Cuts, 0);
  ASSERT_EQ(bench.State.Mesh.NumberOfVertices(), before.NumberOfVertices());
  for (int v = 0; v < before.Size(); ++v)
  {
    EXPECT_EQ(Length(bench.State.Mesh.Position[v] - before.Position[v]), 0);
    ASSERT_EQ(bench.State.Mesh.Rings[v].Count, before.Rings[v].Count);
    for (int i = 0; i < before.Rings[v].Count; ++i)
    {
      EXPECT_EQ(bench.State.Mesh.Rings[v].Item[i], before.Rings[v].Item[i]);
    }
  }
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Rejection of edits: illegal lengths, flipped faces and intersections.
#include "Core/Surface/SurfaceEditor.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
/** A sphere. */
struct Workbench : LiveSurface
{
  explicit Workbench(double edge)
    : LiveSurface(DividedIcosahedron({ 0, 0, 0 }, 10.2, edge)), Editor(*this)
  {
  }

  const Vector& At(int v) const { return this->Mesh.Position[v]; }
  Vector Outward(int v) const { return Normalized(this->At(v)); }

  static constexpr int V = 40;
  int W = this->Mesh.Rings[V].Item[0];
  SurfaceEditor Editor;
};

constexpr double Fine = 1.3;   ///< Edge lengths from 1.1 to 1.25.
constexpr double Coarse = 2.2; ///< About 2.
}

TEST(SurfaceEditor, SplitInterpolatesPositionAndMotion)
{
  Workbench bench(Coarse);
  SurfaceState& s = bench;
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
    LiveSurface bench(surface);
    const bool done = SurfaceEditor(bench).Merge(0, 6 + 1).IsDone;
    EXPECT_TRUE(bench.IsSound());
    EXPECT_EQ(bench.EulerCharacteristic, (obstructed ? 6 : 4) - (done ? 2 : 0));
    return done;
  };
  EXPECT_TRUE(merged(0.5, false));
  EXPECT_FALSE(merged(0.5, true));
  EXPECT_TRUE(merged(1.5, false)) << "bridge edge length 3.5";
  EXPECT_FALSE(merged(3, false)) << "bridge edge length 5";
}

TEST(SurfaceEditor, RejectedCutRestoresSurface)
{
  // A needle along the tube, at the position of the two caps.
  IndexedSurface surface = MakeTorus({ 0, 0, 0 }, 5, 0.5, 18, 3);
  AddSurface(surface, Octahedron({ 5, 0, 0 }, 0.05, 0.8, 0.05));
  LiveSurface bench(surface);
  ASSERT_TRUE(bench.IsSound());
  const SurfaceMesh before = bench.Mesh;
  EXPECT_FALSE(SurfaceEditor(bench).Cut(0, 1, 2));
  EXPECT_TRUE(bench.IsSound());
  EXPECT_EQ(bench.EulerCharacteristic, 2);
  EXPECT_EQ(bench.Counts.Cuts, 0);
  ASSERT_EQ(bench.Mesh.NumberOfVertices(), before.NumberOfVertices());
  for (int v = 0; v < before.Size(); ++v)
  {
    EXPECT_EQ(Length(bench.Mesh.Position[v] - before.Position[v]), 0);
    ASSERT_EQ(bench.Mesh.Rings[v].Count, before.Rings[v].Count);
    for (int i = 0; i < before.Rings[v].Count; ++i)
    {
      EXPECT_EQ(bench.Mesh.Rings[v].Item[i], before.Rings[v].Item[i]);
    }
  }
}

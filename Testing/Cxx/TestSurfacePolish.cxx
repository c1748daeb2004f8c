// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceOptions.h"
#include "Core/Mesh/EdgeFlip.h"
#include "Core/Surface/SurfacePolish.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
/** Any part may be near another. */
struct CrowdedSurface : LiveSurface
{
  explicit CrowdedSurface(const SurfaceMesh& mesh) : LiveSurface(mesh) { this->NearOthers.Fill(1); }
};

std::vector<int> AliveOnes(const SurfaceState& state)
{
  std::vector<int> alive;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (state.Mesh.IsAlive(v))
    {
      alive.push_back(v);
    }
  }
  return alive;
}

/** A sphere whose vertices have been moved about on it. */
SurfaceMesh ShakenSphere(unsigned seed)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 8, 1.5);
  std::mt19937 engine(seed);
  for (Vector& p : mesh.Position)
  {
    const auto shake = [&engine]() { return 0.001f * (static_cast<int>(engine() % 701) - 350); };
    p = Normalized(p + Vector(shake(), shake(), shake())) * 8.f;
  }
  return mesh;
}

struct Shape
{
  int EdgesOutside = 0;
  double WorstRatio = 1;
};

Shape ShapeOf(const SurfaceState& state)
{
  Shape shape;
  state.Mesh.VisitFaces(
    [&](int a, int b, int c)
    {
      double edge[3] = { 0, 0, 0 };
      const int corner[3] = { a, b, c };
      for (int k = 0; k < 3; ++k)
      {
        edge[k] = Length(VectorD(state.Mesh.Position[corner[(k + 1) % 3]]) -
          VectorD(state.Mesh.Position[corner[k]]));
        shape.EdgesOutside +=
          edge[k] < state.Sizing.OfLevel() || edge[k] > 2.5 * state.Sizing.OfLevel();
      }
      shape.WorstRatio = std::min(shape.WorstRatio,
        (edge[0] + edge[1] - edge[2]) * (edge[1] + edge[2] - edge[0]) *
          (edge[2] + edge[0] - edge[1]) / (edge[0] * edge[1] * edge[2]));
    });
  return shape;
}
}

TEST(SurfacePolish, LeavesNoEdgeOutsideTheBoundsAndNoUnevenTriangle)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    CrowdedSurface state(ShakenSphere(seed));
    ASSERT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
    const Shape before = ShapeOf(state);
    ASSERT_GT(before.EdgesOutside, 10);
    ASSERT_LT(before.WorstRatio, 0.5);
    SurfacePolish polish(state, nullptr, false);
    polish.Run(AliveOnes(state));
    const Shape after = ShapeOf(state);
    EXPECT_EQ(after.EdgesOutside, 0);
    EXPECT_GT(after.WorstRatio, 0.5);
    EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
    EXPECT_EQ(state.Mesh.CountEulerCharacteristic(), 2);
    EXPECT_EQ(state.EulerCharacteristic, 2);
    EXPECT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
    EXPECT_FALSE(polish.TakeChanged().empty());
  }
}

TEST(SurfacePolish, PushesApartWhatIsFarApartOnTheSurface)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 8, 1.5);
  mesh.Append(DividedIcosahedron({ 0, 0, 0 }, 6.9, 1.5));
  CrowdedSurface state(mesh);
  const auto nearest = [&state]()
  {
    // The two components are far apart on the surface throughout.
    double least = 1e9;
    for (int v = 0; v < state.Mesh.Size(); ++v)
    {
      for (int w = 0; w < state.Mesh.Size(); ++w)
      {
        const Vector& p = state.Mesh.Position[v];
        const Vector& q = state.Mesh.Position[w];
        if (state.Mesh.IsAlive(v) && state.Mesh.IsAlive(w) && Length(p) > 7.4f &&
          Length(q) < 7.4f)
        {
          least = std::min(least, static_cast<double>(Length(p - q)));
        }
      }
    }
    return least;
  };
  ASSERT_LT(nearest(), 1.2);
  SurfacePolish(state, nullptr, false).Run(AliveOnes(state));
  EXPECT_GT(nearest(), 1.42); // lambda = 1.443
  EXPECT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
  EXPECT_EQ(state.Mesh.CountEulerCharacteristic(), 4);
}

TEST(SurfacePolish, StaysOnTheIsopotential)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    const TestVolume volume = MakeVolume(33, [](double x, double y, double z)
      { return 8 - Distance(x, y, z, 16, 16, 16); });
    Executor executor;
    const Field field(volume.Image, SurfaceOptions(), executor);
    double worst[2] = { 0, 0 };
    for (const bool snap : { false, true })
    {
      SurfaceMesh mesh = ShakenSphere(seed);
      for (Vector& p : mesh.Position)
      {
        p += Vector(16, 16, 16);
      }
      LiveSurface state(mesh);
      SurfacePolish(state, snap ? &field : nullptr, false).Run(AliveOnes(state));
      EXPECT_EQ(ShapeOf(state).EdgesOutside, 0);
      for (int v = 0; v < state.Mesh.Size(); ++v)
      {
        if (state.Mesh.IsAlive(v))
        {
          worst[snap] += std::abs(field.ValueAt(state.Mesh.Position[v])) / state.Mesh.Size();
        }
      }
    }
    EXPECT_LT(worst[true], 0.7 * worst[false]) << "mean distance, seed " << seed;
  }
}

TEST(SurfacePolish, FlipsWhereThatIsAllThatIsNeeded)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 8, 1.7);
  // Vertices are looked at in order of index: an end of the bad edge must be the first.
  int u = 40;
  EdgeFlip flip = EdgeFlip::Of(mesh, u, mesh.Rings[u].Item[0]);
  while (std::min(flip.A, flip.B) > std::min(flip.U, flip.V))
  {
    ++u;
    flip = EdgeFlip::Of(mesh, u, mesh.Rings[u].Item[0]);
  }
  const int v = flip.V;
  flip.Apply(mesh);
  ASSERT_FALSE(mesh.AreNeighbours(u, v));
  CrowdedSurface state(mesh);
  SurfacePolish(state, nullptr, true).Run(AliveOnes(state));
  EXPECT_TRUE(state.Mesh.AreNeighbours(u, v));
  EXPECT_EQ(state.Counts.Flips, 1);
  for (int w = 0; w < mesh.Size(); ++w)
  {
    EXPECT_EQ(Length(state.Mesh.Position[w] - mesh.Position[w]), 0);
  }
}

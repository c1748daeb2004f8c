// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceOptimization.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
/** A surface whose vertices are all marked as near others. */
struct CrowdedSurface : LiveSurface
{
  explicit CrowdedSurface(const SurfaceMesh& mesh) : LiveSurface(mesh) { this->NearOthers.Fill(1); }
};

/** Return a sphere with vertices displaced randomly on it. */
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

TEST(SurfaceOptimization, RestoresEdgeLengthsAndTriangleQuality)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    CrowdedSurface state(ShakenSphere(seed));
    ASSERT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
    const Shape before = ShapeOf(state);
    ASSERT_GT(before.EdgesOutside, 10);
    ASSERT_LT(before.WorstRatio, 0.5);
    SurfaceOptimization optimize(state, nullptr, false);
    optimize.Run(state.All());
    const Shape after = ShapeOf(state);
    EXPECT_EQ(after.EdgesOutside, 0);
    EXPECT_GT(after.WorstRatio, 0.5);
    EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
    EXPECT_EQ(state.Mesh.CountEulerCharacteristic(), 2);
    EXPECT_EQ(state.EulerCharacteristic, 2);
    EXPECT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
    EXPECT_FALSE(optimize.TakeChanged().empty());
  }
}

TEST(SurfaceOptimization, RestoresClearance)
{
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 8, 1.5);
  mesh.Append(DividedIcosahedron({ 0, 0, 0 }, 6.9, 1.5));
  CrowdedSurface state(mesh);
  const auto nearest = [&state]()
  {
    // The two components are not connected.
    double least = 1e9;
    for (int v = 0; v < state.Mesh.Size(); ++v)
    {
      for (int w = 0; w < state.Mesh.Size(); ++w)
      {
        const Vector& p = state.Mesh.Position[v];
        const Vector& q = state.Mesh.Position[w];
        if (state.Mesh.IsAlive(v) && state.Mesh.IsAlive(w) && Length(p) > 7.4f && Length(q) < 7.4f)
        {
          least = std::min(least, static_cast<double>(Length(p - q)));
        }
      }
    }
    return least;
  };
  ASSERT_LT(nearest(), 1.2);
  SurfaceOptimization(state, nullptr, false).Run(state.All());
  EXPECT_GT(nearest(), 1.42); // lambda = 1.443
  EXPECT_EQ(CountSelfIntersections(state.Mesh.ToIndexed()), 0);
  EXPECT_EQ(state.Mesh.CountEulerCharacteristic(), 4);
}

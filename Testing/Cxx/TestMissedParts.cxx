// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedParts.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "EvolutionTestTools.h"

using namespace volumic;

namespace
{
constexpr float Delta = 0.85f;
/** A ball enclosed by the surface, with a missed cavity, and a missed ball. */
TestVolume Scene()
{
  return MakeVolume(48,
    [](double x, double y, double z)
    {
      const double ball = Distance(x, y, z, 18, 24, 24) - 13.;
      const double bubble = 6. - Distance(x, y, z, 17, 24, 24);
      const double missed = Distance(x, y, z, 40, 24, 24) - 4.;
      return Soft(std::min(std::max(ball, bubble), missed));
    });
}

/** The surface of the enclosed ball. */
struct EnclosedBall
{
  TestVolume Volume;
  Field Image;
  SurfaceState State;

  explicit EnclosedBall(TestVolume volume = Scene())
    : Volume(std::move(volume)), Image(this->Volume.Image, IsoHalf(), Threads)
  {
    this->State.Mesh = MakeSphere({ 18, 24, 24 }, 13., 1.4 * Delta);
    this->State.Sizing = SizingField(Delta);
    this->State.Reset(Vector(-2, -2, -2), Vector(50, 50, 50));
  }

  MissedBoundary::Missing MissedBy(const MissedBoundary& boundary) const
  {
    const double area = ComputeFeatures(this->State.Mesh.ToIndexed()).Area;
    return boundary.MissedBy(this->State, area, this->Image, Threads);
  }

  RecoverySurfaces Find(PartKind kind, int minimumSize) const
  {
    return FindMissedParts(
      this->State, this->Image, kind, minimumSize, RecoveryShape::Even, Threads);
  }
};

double NearestVertex(const SurfaceState& state, const IndexedSurface& surface)
{
  double nearest = std::numeric_limits<double>::max();
  for (const Vector& p : state.Mesh.Position)
  {
    for (const Point& q : surface.Points)
    {
      nearest = std::min(nearest, Distance(p.X, p.Y, p.Z, q[0], q[1], q[2]));
    }
  }
  return nearest;
}
}

TEST(MissedParts, EnclosesMissedObjectsAndCavities)
{
  const EnclosedBall ball;
  for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
  {
    const bool isObject = kind == PartKind::Object;
    const RecoverySurfaces found = ball.Find(kind, 20);
    EXPECT_EQ(found.Found, 1);
    EXPECT_EQ(found.Enclosed, 1);
    EXPECT_EQ(ball.Find(kind, isObject ? 265 : 1000).Found, 0) << "below the minimum size";
    const SurfaceFeatures features = ComputeFeatures(found.Surface);
    ASSERT_EQ(features.Components.size(), 1u);
    EXPECT_EQ(features.Genus, 0);
    // It encloses the part; for a cavity it is inverted.
    EXPECT_GT(
      isObject ? features.Volume : -features.Volume, 4. / 3. * 3.14159 * (isObject ? 64. : 216.));
    const Point& c = features.Components[0].Centroid;
    EXPECT_LT(Distance(c[0], c[1], c[2], isObject ? 40 : 17, 24, 24), 1.);
    EXPECT_GE(NearestVertex(ball.State, found.Surface), SizingField::LambdaInDelta * Delta);
  }
}

TEST(MissedParts, IgnoresVoxelsAtSurface)
{
  // The surface is up to 1.2 voxels away from the boundary.
  for (const double radius : { 11.8, 14.2 })
  {
    const EnclosedBall ball(MakeVolume(48,
      [radius](double x, double y, double z)
      { return Soft(Distance(x, y, z, 18, 24, 24) - radius); }));
    EXPECT_EQ(ball.Find(PartKind::Object, 1).Found, 0);
    EXPECT_EQ(ball.Find(PartKind::Cavity, 1).Found, 0);
  }
}

TEST(MissedParts, RecoverySurfacesOfNoiseAreValid)
{
  std::mt19937 random(3);
  for (int round = 0; round < 6; ++round)
  {
    // Sheets, tunnels and small components as wide as the cubes of the lattice.
    std::uniform_real_distribution<double> phase(0., 6.28), wave(-2.5, 2.5);
    std::array<std::array<double, 4>, 12> waves;
    for (std::array<double, 4>& w : waves)
    {
      w = { wave(random), wave(random), wave(random), phase(random) };
    }
    const TestVolume volume = MakeVolume(28,
      [&waves](double x, double y, double z)
      {
        double sum = 0.;
        for (const std::array<double, 4>& w : waves)
        {
          sum += std::sin(w[0] * x + w[1] * y + w[2] * z + w[3]);
        }
        return Soft(1.5 - sum);
      });
    const Field field(volume.Image, IsoHalf(), Threads);
    SurfaceState state;
    state.Sizing = SizingField(Delta);
    state.Reset(Vector(-2, -2, -2), Vector(30, 30, 30));
    for (const RecoveryShape shape : { RecoveryShape::Safe, RecoveryShape::Even })
    {
      const RecoverySurfaces found =
        FindMissedParts(state, field, PartKind::Object, 20, shape, Threads);
      EXPECT_GT(found.Enclosed, 0);
      EXPECT_EQ(found.Enclosed, found.Found);
      EXPECT_NO_THROW(SurfaceMesh().Append(found.Surface)) << "closed, manifold, oriented";
      EXPECT_EQ(CountSelfIntersections(found.Surface), 0);
    }
  }
}

TEST(MissedParts, BoundaryWithoutNearbyVertexIsMissed)
{
  EnclosedBall ball;
  const RecoverySurfaces found = ball.Find(PartKind::Object, 20);
  const MissedBoundary::Missing before = ball.MissedBy(found.Boundary);
  EXPECT_EQ(before.Parts, 1);
  // Spheres of radius 4 and 13.
  EXPECT_NEAR(before.Share, 16. / (16. + 169.), 0.01);

  ball.State.Mesh.Append(DividedIcosahedron({ 40, 24, 24 }, 4., 1.4 * Delta));
  ball.State.Reset(Vector(-2, -2, -2), Vector(50, 50, 50));
  const MissedBoundary::Missing after = ball.MissedBy(found.Boundary);
  EXPECT_EQ(after.Parts, 0);
  EXPECT_EQ(after.Share, 0.);
}

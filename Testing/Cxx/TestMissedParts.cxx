// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/MissedParts.h"
#include "Core/Evolution/MissedVoxels.h"
#include "Core/Image/VoxelNumbers.h"
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

/** More voxels in a row than bits in a word, more layers than a slab. */
constexpr int Size = 72;
constexpr double Centre = 35.6;
constexpr double Radius = 11.;

/** Random object voxels. */
TestVolume Noise(unsigned int percent)
{
  return MakeVolume(Size,
    [percent](double x, double y, double z)
    {
      auto hash = static_cast<std::uint32_t>(x + Size * (y + Size * z));
      for (const std::uint32_t factor : { 2654435761u, 2246822519u, 3266489917u })
      {
        hash = (hash ^ hash >> 15) * factor;
      }
      return (hash >> 8) % 100 < percent ? 1. : 0.;
    });
}

/** Mark the missed voxels by brute force. */
std::vector<std::uint8_t> Marks(const SurfaceState& state, const Field& field, PartKind kind)
{
  const VoxelNumbers numbers({ Size, Size, Size });
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(numbers.Count()), 0);
  for (std::int64_t voxel = 0; voxel < numbers.Count(); ++voxel)
  {
    const std::array<int, 3> p = numbers.IjkOf(voxel);
    const bool isObject = kind == PartKind::Object;
    const bool isInside = Distance(p[0], p[1], p[2], Centre, Centre, Centre) < Radius;
    marks[voxel] = isInside != isObject && (field.Voxel(p[0], p[1], p[2]) > 0) == isObject;
  }
  for (const Vector& v : state.Mesh.Position)
  {
    const auto first = [](float x) { return std::max(0, static_cast<int>(x - NearUnits)); };
    const auto end = [](float x) { return std::min(Size, static_cast<int>(x + NearUnits) + 1); };
    ForBox({ first(v.X), first(v.Y), first(v.Z) }, { end(v.X), end(v.Y), end(v.Z) },
      [&](int i, int j, int k)
      {
        if (Distance(i, j, k, v.X, v.Y, v.Z) <= NearUnits)
        {
          marks[numbers.Of(i, j, k)] = 0;
        }
      });
  }
  return marks;
}

using Parts = std::vector<std::vector<std::int64_t>>;

/** Return the face-connected components, in the order of their first voxels. */
Parts PartsOf(std::vector<std::uint8_t> marks, std::size_t minimumSize)
{
  const VoxelNumbers numbers({ Size, Size, Size });
  Parts all;
  for (std::int64_t first = 0; first < numbers.Count(); ++first)
  {
    std::vector<std::int64_t> part;
    const auto take = [&](std::int64_t voxel)
    {
      if (std::exchange(marks[static_cast<std::size_t>(voxel)], 0) != 0)
      {
        part.push_back(voxel);
      }
    };
    take(first);
    for (std::size_t n = 0; n < part.size(); ++n)
    {
      const std::array<int, 3> ijk = numbers.IjkOf(part[n]);
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::int64_t voxel = part[n];
        ijk[axis] > 0 ? take(voxel - numbers.Stride(axis)) : void();
        ijk[axis] + 1 < Size ? take(voxel + numbers.Stride(axis)) : void();
      }
    }
    if (!part.empty() && part.size() >= minimumSize)
    {
      std::sort(part.begin(), part.end());
      all.push_back(part);
    }
  }
  return all;
}

Parts PartsOf(const MissedVoxels& missed)
{
  Parts all(static_cast<std::size_t>(missed.Parts));
  for (const VoxelRun& run : missed.Runs)
  {
    for (int i = 0; i < run.Length; ++i)
    {
      all.at(static_cast<std::size_t>(run.Part)).push_back(run.First + i);
    }
  }
  return all;
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

TEST(MissedVoxels, EqualVoxelsAndPartsOfWholeImage)
{
  SurfaceState state;
  state.Mesh = MakeSphere({ Centre, Centre, Centre }, Radius, 1.2);
  state.Sizing = SizingField(0.85f);
  state.Reset(Vector(-2, -2, -2), Vector(Size + 2, Size + 2, Size + 2));
  Executor alone;
  Executor threads(3);
  const std::array<Executor*, 2> executors = { &alone, &threads };
  for (const unsigned int percent : { 3u, 28u, 34u, 60u, 97u })
  {
    const TestVolume volume = Noise(percent);
    const Field field(volume.Image, IsoHalf(), alone);
    for (const PartKind kind : { PartKind::Object, PartKind::Cavity })
    {
      const std::vector<std::uint8_t> marks = Marks(state, field, kind);
      for (const int minimumSize : { 1, 2, 20 })
      {
        const Parts requested = PartsOf(marks, static_cast<std::size_t>(minimumSize));
        for (Executor* executor : executors)
        {
          const MissedVoxels missed =
            FindMissedVoxels(state, field, kind, minimumSize, *executor, NeverStop);
          EXPECT_EQ(PartsOf(missed), requested) << percent << " %, at least " << minimumSize;
        }
      }
    }
  }
}

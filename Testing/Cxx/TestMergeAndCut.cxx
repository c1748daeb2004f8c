// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What has come near is merged where the image wants it, nearest first; what is thin is cut.
#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/StarMerge.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/Remesher.h"
#include "EvolutionTestTools.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
int Nearest(const SurfaceMesh& mesh, const Vector& place, int from, int to)
{
  int best = from;
  for (int v = from; v < to; ++v)
  {
    if (SquaredDistance(mesh.Position[v], place) < SquaredDistance(mesh.Position[best], place))
    {
      best = v;
    }
  }
  return best;
}
}

TEST(StarMerge, RefusesRimsThatTouch)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  StarMerge merge;
  merge.U = 20;
  merge.V = mesh.Rings[20].Item[0];
  EXPECT_FALSE(merge.Plan(mesh));
  merge.V = mesh.Rings[merge.V].Item[0];
  EXPECT_FALSE(merge.Plan(mesh));
}

TEST(StarMerge, MakesAManifoldOfAnyTwoStars)
{
  // Far and skew pairs tempt the strip into staying on one vertex for a whole turn.
  for (int i = 0; i < 60; ++i)
  {
    SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
    const Point centre = { 5. + i % 7, 1. * (i % 5), 1. * (i % 3) };
    const int second = mesh.Append(DividedIcosahedron(centre, 1.5, 0.9));
    StarMerge merge;
    merge.U = i % second;
    merge.V = second + (i * 7) % (mesh.Size() - second);
    ASSERT_TRUE(merge.Plan(mesh));
    merge.Apply(mesh);
    ASSERT_EQ(DescribeBrokenInvariant(mesh), "") << "pair " << i;
    ASSERT_EQ(mesh.CountEulerCharacteristic(), 2);
  }
}

TEST(StarMerge, TakesTheShortestBridgeEdges)
{
  // Mirror images of each other: every vertex of a rim has its own across.
  SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  IndexedSurface mirrored = mesh.ToIndexed();
  for (Point& p : mirrored.Points)
  {
    p[0] = 7 - p[0];
  }
  for (Triangle& t : mirrored.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  const int second = mesh.Append(mirrored);
  StarMerge merge;
  merge.U = Nearest(mesh, Vector(3, 0, 0), 0, second);
  merge.V = merge.U + second;
  ASSERT_TRUE(merge.Plan(mesh));
  const Ring rim = mesh.Rings[merge.U];
  double longest = 0;
  double shortest = 1e9;
  for (int i = 0; i < rim.Count; ++i)
  {
    longest = std::max(longest, 7. - 2 * mesh.Position[rim.Item[i]].X);
    shortest = std::min(shortest, 7. - 2 * mesh.Position[rim.Item[i]].X);
  }
  merge.Apply(mesh);
  double diagonal = 0;
  for (int i = 0; i < rim.Count; ++i)
  {
    EXPECT_TRUE(mesh.AreNeighbours(rim.Item[i], rim.Item[i] + second)) << "straight across";
    for (int k : { rim.Item[i] + second, rim.Next(i) + second, rim.Previous(i) + second })
    {
      if (mesh.AreNeighbours(rim.Item[i], k))
      {
        diagonal = std::max(diagonal,
          static_cast<double>(SquaredDistance(mesh.Position[rim.Item[i]], mesh.Position[k])));
      }
    }
  }
  EXPECT_GT(shortest, 0.9);
  EXPECT_GE(merge.SquaredLongestBridgeEdge(), longest * longest - 1e-4);
  EXPECT_NEAR(merge.SquaredLongestBridgeEdge(), diagonal, 1e-4);
}

TEST(StarMerge, RefusesABandThatWouldOverfillARing)
{
  // Each vertex of the belt of a double cone of three sides has four neighbours; the rim of a tip
  // of fifteen sides hands five bridge edges to each.
  const auto cone = [](double z, int sides, int crowded)
  {
    IndexedSurface surface;
    surface.Points = { { 0, 0, z + 1 }, { 0, 0, z - 1 } };
    for (int i = 0; i < sides; ++i)
    {
      const double a = 2 * 3.14159265358979 * i / sides;
      surface.Points.push_back({ 3 * std::cos(a), 3 * std::sin(a), z });
    }
    for (int i = 0; i < sides; ++i)
    {
      const int next = 2 + (i + 1) % sides;
      surface.Triangles.push_back({ 0, 2 + i, next });
      if (i != 0)
      {
        surface.Triangles.push_back({ 1, next, 2 + i });
        continue;
      }
      // About the first side vertices are strung, so that its end has more neighbours.
      int last = 2;
      for (int k = 0; k < crowded; ++k)
      {
        const double share = (k + 1.) / (crowded + 1);
        const int added = static_cast<int>(surface.Points.size());
        surface.Points.push_back({ 2.9 * share, 0, z - 0.9 + 0.5 * share });
        surface.Triangles.push_back({ next, last, added });
        surface.Triangles.push_back({ 1, added, last });
        last = added;
      }
      surface.Triangles.push_back({ 1, next, last });
    }
    return surface;
  };
  for (const int crowded : { 0, 9 })
  {
    SurfaceMesh mesh;
    const IndexedSurface lower = cone(0, 3, crowded);
    const int second = mesh.Append(lower);
    ASSERT_EQ(second, 0);
    const int upper = mesh.Append(cone(3, 15, 0));
    StarMerge merge;
    merge.U = 0;
    merge.V = upper + 1;
    EXPECT_EQ(merge.Plan(mesh), crowded == 0) << crowded;
  }
}

namespace
{
using Image = std::function<double(double, double, double)>;

/** A surface with what is near what, and an image whose iso-value is 0. */
struct Scene : Bench
{
  TestVolume Volume;
  std::unique_ptr<Field> TheField;
  Proximity Near;

  explicit Scene(const IndexedSurface& surface, const Image& image = nullptr) : Bench(surface)
  {
    if (image)
    {
      this->Volume = MakeVolume(33, image);
      this->TheField = std::make_unique<Field>(this->Volume.Image, SurfaceOptions(), this->Threads);
    }
    this->Near.Examine(this->State, this->All(), OnThisThread());
  }

  int Merges(bool topologyChanges = true)
  {
    return this->Merges(this->Near.Pairs(), topologyChanges);
  }
  int Merges(const std::vector<Proximity::ClosePair>& pairs, bool topologyChanges = true)
  {
    Remesher(this->State, this->TheField.get(), topologyChanges).Merge(pairs);
    EXPECT_TRUE(this->IsSound());
    EXPECT_EQ(this->State.Counts.Merges * 2 + this->State.EulerCharacteristic, this->Chi);
    return this->State.Counts.Merges;
  }

  /** Both sides of the nearest pair. */
  std::vector<Proximity::ClosePair> NearestPair() const
  {
    Proximity::ClosePair nearest{ -1, -1, 1e9f };
    for (const Proximity::ClosePair& pair : this->Near.Pairs())
    {
      nearest = pair.Squared < nearest.Squared ? pair : nearest;
    }
    return { nearest, { nearest.W, nearest.V, nearest.Squared } };
  }

  int Chi = this->State.EulerCharacteristic;
};

/** A ball with a vertex at either end along x. */
IndexedSurface Ball(double x, double radius, double edge)
{
  IndexedSurface ball = DividedIcosahedron({ 0, 0, 0 }, radius, edge);
  const Point tip = Icosahedron({ 0, 0, 0 }, 1).Points[9];
  for (Point& p : ball.Points)
  {
    p = { x + tip[0] * p[0] + tip[2] * p[2], 16 + p[1], 16 + tip[0] * p[2] - tip[2] * p[0] };
  }
  return ball;
}

/** Two balls whose tips face each other about (16, 16, 16), along x. */
IndexedSurface TwoBalls(double gap = 1.2, double radius = 4, double edge = 1.6)
{
  IndexedSurface surface = Ball(16 - gap / 2 - radius, radius, edge);
  AddSurface(surface, Ball(16 + gap / 2 + radius, radius, edge));
  return surface;
}

/** A wall of a thickness of 1.2 between two spheres. */
IndexedSurface Shell()
{
  IndexedSurface surface = DividedIcosahedron({ 16, 16, 16 }, 7.2, 1.6);
  AddSurface(surface, InsideOut(DividedIcosahedron({ 16, 16, 16 }, 6, 1.6)));
  return surface;
}

Image Everywhere(double value)
{
  return [value](double, double, double) { return value; };
}

/** `middle` at x = 16, `ends` half a gap away and beyond. */
Image Between(double middle, double ends)
{
  return [middle, ends](double x, double, double)
  { return ends + (middle - ends) * std::max(0., 1 - 2 * std::abs(x - 16)); };
}
}

TEST(Merging, JoinsTwoBallsWhereTheImageIsObjectBetweenThem)
{
  Scene wanted(TwoBalls(), Everywhere(1));
  ASSERT_FALSE(wanted.Near.Pairs().empty());
  EXPECT_EQ(wanted.Merges(), 1);
  EXPECT_EQ(ComputeFeatures(wanted.State.Mesh.ToIndexed()).Components.size(), 1u);
  EXPECT_EQ(Scene(TwoBalls(), Everywhere(-1)).Merges(), 0) << "background";
  EXPECT_EQ(Scene(TwoBalls(), Everywhere(1)).Merges(false), 0) << "the topology must stay";
}

TEST(Merging, AsksForTheMiddleAndForBothEnds)
{
  // At a distance of .6 from the middle the linear image has all but reached its value there.
  EXPECT_GT(Scene(TwoBalls(), Between(0.5, 1)).Merges(), 0);
  EXPECT_EQ(Scene(TwoBalls(), Between(-0.5, 1)).Merges(), 0) << "a gap in the object";
  EXPECT_EQ(Scene(TwoBalls(), Between(0.5, -1)).Merges(), 0) << "the surface is still far off";
}

TEST(Merging, BreaksThroughAWallWhereTheImageIsBackground)
{
  EXPECT_GT(Scene(Shell(), Everywhere(-1)).Merges(), 0);
  EXPECT_EQ(Scene(Shell(), Everywhere(1)).Merges(), 0);
}

TEST(Merging, NeedsNormalsThatFaceEachOther)
{
  const auto with = [](const Vector& normal, const Vector& other, double value)
  {
    Scene scene(TwoBalls(), Everywhere(value));
    const auto pair = scene.NearestPair();
    const bool first = scene.State.Mesh.Position[pair[0].V].X < 16;
    scene.State.Normal[first ? pair[0].V : pair[0].W] = NormalCone(normal, 0);
    scene.State.Normal[first ? pair[0].W : pair[0].V] = NormalCone(other, 0);
    return scene.Merges(pair);
  };
  const Vector right(1, 0, 0);
  const Vector left(-1, 0, 0);
  const Vector up(0, 1, 0);
  EXPECT_EQ(with(right, left, 1), 1);
  EXPECT_EQ(with(right, right, 1), 0) << "one behind the other";
  EXPECT_EQ(with(right, right, -1), 0);
  EXPECT_EQ(with(up, -up, 1), 0) << "passing by";
  EXPECT_EQ(with(up, -up, -1), 0);
  EXPECT_EQ(with(Normalized(up + right * 0.5f), Normalized(up - right * 0.5f), 1), 0)
    << "two sides of a groove";
}

TEST(Merging, WithoutAnImageJoinsWhatApproaches)
{
  for (const float speed : { 0.1f, -0.1f })
  {
    Scene scene(TwoBalls());
    for (int v : scene.All())
    {
      scene.State.Velocity[v].X = scene.State.Mesh.Position[v].X < 16 ? speed : -speed;
    }
    EXPECT_EQ(scene.Merges(), speed > 0 ? 1 : 0);
  }
}

TEST(Merging, TakesTheNearestPairFirst)
{
  Scene scene(TwoBalls(0.9, 5.9, 1.3), Everywhere(1));
  const Proximity::ClosePair nearest = scene.NearestPair().front();
  ASSERT_GT(scene.Near.Pairs().size(), 2u);
  scene.Merges();
  EXPECT_FALSE(scene.State.Mesh.IsAlive(nearest.V));
  EXPECT_FALSE(scene.State.Mesh.IsAlive(nearest.W));
}

TEST(Merging, LeavesWhatIsFartherThanLambdaDelta)
{
  // Examinations list pairs a little farther away as well.
  for (const double gap : { 1.4, 1.5 })
  {
    Scene scene(TwoBalls(gap), Everywhere(1));
    const int half = scene.State.Mesh.Size() / 2;
    const int v = scene.Nearest(Vector(16, 16, 16), 0, half);
    const int w = scene.Nearest(Vector(16, 16, 16), half, 2 * half);
    const float squared =
      SquaredDistance(scene.State.Mesh.Position[v], scene.State.Mesh.Position[w]);
    ASSERT_EQ(squared < 1.443f * 1.443f, gap < 1.45) << squared;
    EXPECT_EQ(scene.Merges({ { v, w, squared } }), gap < 1.45 ? 1 : 0);
  }
}

TEST(Merging, LeavesNoEdgeThatIsTooLong)
{
  // Rims far behind the tips: bridge edges of over 2.5 delta.
  Scene scene(TwoBalls(1.4, 3.4, 2.1), Everywhere(1));
  ASSERT_LE(scene.Longest(), 2.5f);
  EXPECT_EQ(scene.Merges(), 1);
  EXPECT_GT(scene.State.Counts.Splits, 0);
  EXPECT_LE(scene.Longest(), 2.5f);
}

namespace
{
/** Across an edge of a sphere two vertices are raised, and lean over to each other. */
int FlipsOfAFold(double value, bool raised)
{
  Scene scene(DividedIcosahedron({ 16, 16, 16 }, 8, 1.6), Everywhere(value));
  const SurfaceMesh& mesh = scene.State.Mesh;
  const int a = 40;
  const int b = mesh.Rings[a].Item[0];
  const int u = mesh.Rings[a].Next(0);
  const int v = mesh.Rings[a].Previous(0);
  const Vector out = Normalized(mesh.Position[a] - Vector(16, 16, 16)) * (raised ? 0.7f : -0.7f);
  const Vector across = Normalized(mesh.Position[v] - mesh.Position[u]);
  const float lean = 0.5f * (Length(mesh.Position[v] - mesh.Position[u]) - 1.3f);
  scene.MoveTo(u, mesh.Position[u] + across * lean + out);
  scene.MoveTo(v, mesh.Position[v] - across * lean + out);
  const float squared = SquaredDistance(mesh.Position[u], mesh.Position[v]);
  scene.Merges({ { u, v, squared } });
  EXPECT_EQ(scene.State.Counts.Flips > 0, mesh.AreNeighbours(u, v));
  EXPECT_EQ(scene.State.Counts.Flips > 0, !mesh.AreNeighbours(a, b));
  return scene.State.Counts.Flips;
}
}

TEST(Merging, ClosesAFoldByAFlipWhereTheImageWantsIt)
{
  EXPECT_EQ(FlipsOfAFold(1, true), 1) << "a groove in the object is filled";
  EXPECT_EQ(FlipsOfAFold(-1, true), 0) << "not one in the background";
  EXPECT_EQ(FlipsOfAFold(-1, false), 1) << "a ridge in the background is cut off";
  EXPECT_EQ(FlipsOfAFold(1, false), 0);
}

TEST(Merging, AnEvolutionAsksTheImage)
{
  // Seeds grow in two balls whose surfaces come nearer to each other than lambda delta.
  const TestVolume volume = MakeVolume(34,
    [](double x, double y, double z)
    {
      return Soft(
        std::min(Distance(x, y, z, 8.5, 16, 16) - 7, Distance(x, y, z, 23.6, 16, 16) - 7));
    });
  Executor threads;
  Monitor silent;
  SurfaceOptions options;
  options.IsoValue = 0.5;
  TestEvolution evolution(options, threads, silent);
  evolution.StartSeeds(volume.Image, 0, { { 8.5, 16, 16 }, { 23.6, 16, 16 } });
  EXPECT_EQ(evolution.Run(), StopReason::Converged);
  EXPECT_EQ(ComputeFeatures(evolution.Result()).Components.size(), 2u);
}

TEST(CycleCut, RefusesAFace)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int b = mesh.Rings[5].Item[0];
  const int c = mesh.Rings[5].Item[1];
  EXPECT_FALSE((CycleCut{ 5, b, c }).IsLegal(mesh));
  EXPECT_FALSE((CycleCut{ 5, c, b }).IsLegal(mesh));
}

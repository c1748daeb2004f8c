// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Merges, nearest first, if the image requires them, cuts, and remaining contacts.
#include "Core/Mesh/CycleCut.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/RemainingContacts.h"
#include "Core/Surface/Remesher.h"
#include "EvolutionTestTools.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
using Image = std::function<double(double, double, double)>;

/** A surface with its close pairs and an image with iso-value 0. */
struct Scene : LiveSurface
{
  TestVolume Volume;
  std::unique_ptr<Field> TheField;
  Proximity Near;

  explicit Scene(const IndexedSurface& surface, const Image& image = nullptr) : LiveSurface(surface)
  {
    if (image)
    {
      this->Volume = MakeVolume(33, image);
      this->TheField =
        std::make_unique<Field>(this->Volume.Image, SurfaceOptions(), OnThisThread());
    }
    this->Near.Test(*this, this->All(), OnThisThread());
  }

  int Merges(bool topologyChanges = true)
  {
    return this->Merges(this->Near.Pairs(), topologyChanges);
  }
  int Merges(const std::vector<Proximity::ClosePair>& pairs, bool topologyChanges = true)
  {
    Remesher(*this, this->TheField.get(), topologyChanges).Merge(pairs);
    EXPECT_TRUE(this->IsSound());
    EXPECT_EQ(this->Counts.Merges * 2 + this->EulerCharacteristic, this->Chi);
    return this->Counts.Merges;
  }

  /** Return the nearest pair in both orders. */
  std::vector<Proximity::ClosePair> NearestPair() const
  {
    Proximity::ClosePair nearest{ -1, -1, 1e9f };
    for (const Proximity::ClosePair& pair : this->Near.Pairs())
    {
      nearest = pair.Squared < nearest.Squared ? pair : nearest;
    }
    return { nearest, { nearest.W, nearest.V, nearest.Squared } };
  }

  int Chi = this->EulerCharacteristic;
};

/** Return a ball with a vertex at either end along x. */
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

/** Return two balls whose tips face each other about (16, 16, 16), along x. */
IndexedSurface TwoBalls(double gap = 1.2, double radius = 4, double edge = 1.6)
{
  IndexedSurface surface = Ball(16 - gap / 2 - radius, radius, edge);
  AddSurface(surface, Ball(16 + gap / 2 + radius, radius, edge));
  return surface;
}

/** Return a wall of thickness 1.2 between two spheres. */
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

/** `middle` at x = 16, `ends` at half a voxel from it and beyond. */
Image Between(double middle, double ends)
{
  return [middle, ends](double x, double, double)
  { return ends + (middle - ends) * std::max(0., 1 - 2 * std::abs(x - 16)); };
}
}

TEST(Merging, JoinsBallsAcrossForeground)
{
  Scene requested(TwoBalls(), Everywhere(1));
  ASSERT_FALSE(requested.Near.Pairs().empty());
  EXPECT_EQ(requested.Merges(), 1);
  EXPECT_EQ(ComputeFeatures(requested.Mesh.ToIndexed()).Components.size(), 1u);
  EXPECT_EQ(Scene(TwoBalls(), Everywhere(-1)).Merges(), 0) << "background";
  EXPECT_EQ(Scene(TwoBalls(), Everywhere(1)).Merges(false), 0) << "topology changes are off";
}

TEST(Merging, RequiresFieldAtMiddleAndEnds)
{
  // At a distance of 0.6 from the middle the image has nearly reached `ends`.
  EXPECT_GT(Scene(TwoBalls(), Between(0.5, 1)).Merges(), 0);
  EXPECT_EQ(Scene(TwoBalls(), Between(-0.5, 1)).Merges(), 0) << "a gap in the object";
  EXPECT_EQ(Scene(TwoBalls(), Between(0.5, -1)).Merges(), 0)
    << "the surface is far from the isosurface";
}

TEST(Merging, OpensWallAcrossBackground)
{
  EXPECT_GT(Scene(Shell(), Everywhere(-1)).Merges(), 0);
  EXPECT_EQ(Scene(Shell(), Everywhere(1)).Merges(), 0);
}

TEST(Merging, RequiresFacingNormals)
{
  const auto with = [](const Vector& normal, const Vector& other, double value)
  {
    Scene scene(TwoBalls(), Everywhere(value));
    const auto pair = scene.NearestPair();
    const bool first = scene.Mesh.Position[pair[0].V].X < 16;
    scene.Normal[first ? pair[0].V : pair[0].W] = NormalCone(normal, 0);
    scene.Normal[first ? pair[0].W : pair[0].V] = NormalCone(other, 0);
    return scene.Merges(pair);
  };
  const Vector right(1, 0, 0);
  const Vector left(-1, 0, 0);
  const Vector up(0, 1, 0);
  EXPECT_EQ(with(right, left, 1), 1);
  EXPECT_EQ(with(right, right, 1), 0) << "equal directions";
  EXPECT_EQ(with(right, right, -1), 0);
  EXPECT_EQ(with(up, -up, 1), 0) << "perpendicular to the gap";
  EXPECT_EQ(with(up, -up, -1), 0);
  EXPECT_EQ(with(Normalized(up + right * 0.5f), Normalized(up - right * 0.5f), 1), 0)
    << "two sides of a groove";
}

TEST(Merging, WithoutImageJoinsApproachingVertices)
{
  for (const float speed : { 0.1f, -0.1f })
  {
    Scene scene(TwoBalls());
    for (int v : scene.All())
    {
      scene.Velocity[v].X = scene.Mesh.Position[v].X < 16 ? speed : -speed;
    }
    EXPECT_EQ(scene.Merges(), speed > 0 ? 1 : 0);
  }
}

TEST(Merging, LeavesNoLongEdges)
{
  // Links far behind the tips: bridge edges over 2.5 delta.
  Scene scene(TwoBalls(1.4, 3.4, 2.1), Everywhere(1));
  ExpectEdgesWithin(scene.Mesh.ToIndexed(), 0, 2.5);
  EXPECT_EQ(scene.Merges(), 1);
  EXPECT_GT(scene.Counts.Splits, 0);
  ExpectEdgesWithin(scene.Mesh.ToIndexed(), 0, 2.5);
}

namespace
{
/** Raise two vertices on both sides of an edge of a sphere and move them towards each other. */
int FlipsOfAFold(double value, bool raised)
{
  Scene scene(DividedIcosahedron({ 16, 16, 16 }, 8, 1.6), Everywhere(value));
  const SurfaceMesh& mesh = scene.Mesh;
  const int a = 40;
  const int b = mesh.Rings[a].Item[0];
  const int u = mesh.Rings[a].Next(0);
  const int v = mesh.Rings[a].Previous(0);
  const Vector out = Normalized(mesh.Position[a] - Vector(16, 16, 16)) * (raised ? 0.7f : -0.7f);
  const Vector across = Normalized(mesh.Position[v] - mesh.Position[u]);
  const float lean = 0.5f * (Length(mesh.Position[v] - mesh.Position[u]) - 1.3f);
  scene.MoveTo(u, mesh.Position[u] + across * lean + out);
  scene.MoveTo(v, mesh.Position[v] - across * lean + out);
  scene.UpdateShape();
  const float squared = SquaredDistance(mesh.Position[u], mesh.Position[v]);
  scene.Merges({ { u, v, squared } });
  EXPECT_EQ(scene.Counts.Flips > 0, mesh.AreNeighbours(u, v));
  EXPECT_EQ(scene.Counts.Flips > 0, !mesh.AreNeighbours(a, b));
  return scene.Counts.Flips;
}
}

TEST(Merging, FlipClosesFoldIfImageRequires)
{
  EXPECT_EQ(FlipsOfAFold(1, true), 1) << "a groove in the object is filled";
  EXPECT_EQ(FlipsOfAFold(-1, true), 0) << "not in the background";
  EXPECT_EQ(FlipsOfAFold(-1, false), 1) << "a ridge in the background is cut off";
  EXPECT_EQ(FlipsOfAFold(1, false), 0);
}

TEST(CycleCut, RejectsFace)
{
  const SurfaceMesh mesh = MakeSphere({ 0, 0, 0 }, 3, 1);
  const int b = mesh.Rings[5].Item[0];
  const int c = mesh.Rings[5].Item[1];
  EXPECT_FALSE((CycleCut{ 5, b, c }).IsLegal(mesh));
  EXPECT_FALSE((CycleCut{ 5, c, b }).IsLegal(mesh));
}

TEST(ContactCount, CountsFacingVerticesOffIsosurface)
{
  const auto find = [](const IndexedSurface& surface, double value)
  {
    Scene scene(surface,
      [value](double x, double, double) { return value + (x < 3 ? 1. : 0.); }); // slope 1 at x = 3
    return FindRemainingContacts(scene, *scene.TheField, OnThisThread());
  };
  const auto held = [](const RemainingContacts& found)
  { return std::count(found.Held.begin(), found.Held.end(), 1); };
  // Maximum distance 1.15 lambda delta = 1.66; minimum value .015, a tenth of the minimum slope.
  for (const double gap : { 1.5, 1.9 })
  {
    for (const double value : { -0.5, -0.01 })
    {
      const auto count = held(find(TwoBalls(gap), value));
      EXPECT_EQ(count > 0, gap < 1.6 && value < -0.1) << gap << ' ' << value;
      EXPECT_LT(count, 12);
    }
  }
  // Nested surfaces with outward normals do not face each other.
  IndexedSurface nested = DividedIcosahedron({ 16, 16, 16 }, 6, 1.6);
  AddSurface(nested, DividedIcosahedron({ 16, 16, 16 }, 7.3, 1.6));
  const RemainingContacts found = find(nested, -0.5);
  EXPECT_FALSE(found.Pairs.empty());
  EXPECT_EQ(held(found), 0);
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/ComponentWatch.h"
#include "Core/Surface/SurfaceComponents.h"
#include "LiveSurface.h"

using namespace volumic;

namespace
{
const Box Everywhere{ Vector(-1e9f, -1e9f, -1e9f), Vector(1e9f, 1e9f, 1e9f) };

IndexedSurface Ball(const Point& centre, double radius, bool isCavity = false)
{
  const IndexedSurface ball = DividedIcosahedron(centre, radius, 1.5);
  return isCavity ? InsideOut(ball) : ball;
}

/** Surface of several components, with delta 1. */
struct Scene : SurfaceState
{
  explicit Scene(const std::vector<IndexedSurface>& components)
  {
    for (const IndexedSurface& component : components)
    {
      this->Mesh.Append(component);
    }
    this->Sizing = SizingField(1);
    this->Reset(Vector(-40, -40, -40), Vector(60, 40, 40));
  }
};
}

TEST(SurfaceComponents, DeletesInsideOutComponents)
{
  const auto ball = [](double x, double radius) { return Ball({ x, 0, 0 }, radius); };
  const auto cavity = [](double x, double radius) { return Ball({ x, 1, 0 }, radius, true); };
  struct Case
  {
    const char* Name;
    std::vector<IndexedSurface> Components;
    std::vector<int> Kept;
  };
  for (const Case& test :
    { Case{ "a cavity, an island in it, one beside it",
        { ball(0, 15), cavity(0, 10), ball(1, 4), ball(30, 5) }, { 0, 1, 2, 3 } },
      Case{ "cavities in the open", { ball(0, 10), cavity(20, 3), cavity(-20, 3) }, { 0 } },
      Case{ "an island within the object", { ball(0, 15), ball(2, 4) }, { 0 } },
      Case{ "valid components in an inverted one", { cavity(0, 15), ball(1, 9), cavity(1, 4) },
        { 1, 2 } },
      Case{ "a cavity that is in the object without its island",
        { ball(0, 15), ball(0, 10), cavity(0, 5), cavity(0, 2) }, { 0, 2 } },
      Case{ "the only one", { cavity(0, 8) }, {} } })
  {
    SCOPED_TRACE(test.Name);
    Scene state(test.Components);
    SurfaceComponents components;
    const bool isAny = test.Kept.size() < test.Components.size();
    EXPECT_EQ(components.DeleteInsideOut(state, OnThisThread()), isAny);
    EXPECT_EQ(components.NumberOfComponents(), static_cast<int>(test.Kept.size()));
    std::size_t vertices = 0;
    for (const int kept : test.Kept)
    {
      vertices += test.Components[static_cast<std::size_t>(kept)].Points.size();
    }
    EXPECT_EQ(state.Mesh.NumberOfVertices(), static_cast<int>(vertices));
    EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
    EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread())) << "no component is inside out";
  }
}

TEST(SurfaceComponents, LabelsComponentsInOrderOfFirstVertex)
{
  // Interleave the vertices of three components, so that each has vertices in all spans.
  const IndexedSurface ball = DividedIcosahedron({ 0, 0, 0 }, 10, 0.3);
  Scene state({ ball, ball, ball, Ball({ 30, 0, 0 }, 3) });
  const int size = static_cast<int>(ball.Points.size());
  ASSERT_GT(size, 10000);
  std::vector<int> order;
  for (int v = 0; v < size; ++v)
  {
    order.insert(order.end(), { v, v + size, v + 2 * size });
  }
  for (int v = 3 * size; v < state.Mesh.Size(); ++v)
  {
    order.push_back(v);
  }
  state.Mesh.Reorder(order);
  state.Reset(Vector(-40, -40, -40), Vector(60, 40, 40));
  state.FieldValue.Fill(-1.f);
  Executor threads(3);
  SurfaceComponents components;
  components.Label(state, threads);
  EXPECT_EQ(components.NumberOfComponents(), 4);
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    ASSERT_EQ(state.Component[v], v < 3 * size ? v % 3 : 3) << v;
  }
}

TEST(SurfaceComponents, IdentifiesCavityByTotalVolume)
{
  // A torus whose last spans contain the vertices with contributions of the opposite sign.
  const IndexedSurface ring = MakeTorus({ 0, 0, 0 }, 10, 4, 500, 200);
  for (const bool isCavity : { false, true })
  {
    Scene state({ isCavity ? InsideOut(ring) : ring });
    const SurfaceMesh& mesh = state.Mesh;
    std::vector<int> order(mesh.Rings.size());
    std::iota(order.begin(), order.end(), 0);
    const auto last = std::stable_partition(order.begin() + 1, order.end(),
      [&](int v)
      {
        SignedVolume volume(mesh.Position[0]);
        volume.Add(mesh, v);
        return (volume.Value() < 0) == isCavity;
      });
    ASSERT_GT(order.end() - last, 8192 + 1);
    state.Mesh.Reorder(order);
    state.Reset(Vector(-40, -40, -40), Vector(60, 40, 40));
    Executor threads(3);
    SurfaceComponents components;
    EXPECT_EQ(components.DeleteInsideOut(state, threads), isCavity);
  }
}

namespace
{
/** Return whether a ball, or a cavity, of this edge length is deleted for this field value. */
bool IsDeleted(double edge, double value, bool isCavity)
{
  const IndexedSurface ball = DividedIcosahedron({ 30, 0, 0 }, 2, edge);
  Scene state({ Ball({ 0, 0, 0 }, 10), isCavity ? InsideOut(ball) : ball });
  SurfaceComponents components;
  components.Label(state, OnThisThread());
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    state.FieldValue[v] = state.Mesh.Position[v].X > 20 ? static_cast<float>(value) : 0.f;
  }
  const bool deleted = components.DeleteDegenerate(state, OnThisThread());
  EXPECT_EQ(components.NumberOfComponents(), deleted ? 1 : 2);
  EXPECT_EQ(state.EulerCharacteristic, deleted ? 2 : 4);
  EXPECT_EQ(state.Mesh.CountEulerCharacteristic(), state.EulerCharacteristic);
  return deleted;
}
}

TEST(SurfaceComponents, DeletesTinyComponentsOnWrongSide)
{
  constexpr double tiny = 3;   // 12 vertices
  constexpr double larger = 2; // 32 vertices
  EXPECT_TRUE(IsDeleted(tiny, -1, false)) << "an island in the background";
  EXPECT_FALSE(IsDeleted(tiny, 1, false)) << "an island of the object";
  EXPECT_TRUE(IsDeleted(tiny, 1, true)) << "a cavity in the object";
  EXPECT_FALSE(IsDeleted(tiny, -1, true)) << "a cavity of the background";
  EXPECT_FALSE(IsDeleted(larger, -1, false)) << "it is not tiny";
  EXPECT_FALSE(IsDeleted(larger, 1, true));
}

TEST(SurfaceComponents, DeletesVanishedComponents)
{
  IndexedSurface tetrahedron;
  tetrahedron.Points = { { 30, 0, 0 }, { 32, 0, 0 }, { 30, 2, 0 }, { 30, 0, 2 } };
  tetrahedron.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  Scene state({ Ball({ 0, 0, 0 }, 10), tetrahedron });
  SurfaceComponents components;
  components.Label(state, OnThisThread());
  EXPECT_TRUE(components.DeleteDegenerate(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 1);
}

TEST(ComponentWatch, DeletesInvertedComponents)
{
  const IndexedSurface large = Ball({ 0, 0, 0 }, 10);
  Scene state({ large, Ball({ 30, 0, 0 }, 4) });
  ComponentWatch watch;
  watch.LabelSmall(state, 0, state.Mesh.Size(), Everywhere);
  for (const float size : { 0.2f, -0.2f })
  {
    for (int v = static_cast<int>(large.Points.size()); v < state.Mesh.Size(); ++v)
    {
      const Vector direction = Normalized(state.Mesh.Position[v] - Vector(30, 0, 0));
      state.MoveTo(v, Vector(30, 0, 0) + direction * (size > 0 ? size : -0.4f));
    }
    EXPECT_EQ(watch.DeleteDegenerate(state), size < 0) << "its volume has changed sign";
  }
  EXPECT_EQ(state.Mesh.NumberOfVertices(), static_cast<int>(large.Points.size()));
}

TEST(ComponentWatch, WatchesSmallComponentsInRange)
{
  const IndexedSurface large = Ball({ 0, 0, 0 }, 12);
  const IndexedSurface small = Ball({ 30, 0, 0 }, 0.8);
  Scene state({ large, small, Ball({ 40, 0, 0 }, 0.8) });
  const int first = static_cast<int>(large.Points.size());
  const int size = static_cast<int>(small.Points.size());
  ASSERT_GT(first, 800);
  ASSERT_LE(size, 24);
  state.FieldValue.Fill(-1.f); // All on the wrong side.
  ComponentWatch watch;
  // One vertex of the first small ball, and all of the large one, where the search stops early.
  for (int round = 0; round < 2; ++round)
  {
    watch.LabelSmall(state, 0, first + 1, Everywhere);
  }
  const int before = state.Mesh.NumberOfVertices();
  EXPECT_TRUE(watch.DeleteDegenerate(state));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before - size);
  EXPECT_FALSE(state.Mesh.IsAlive(first));
  EXPECT_TRUE(state.Mesh.IsAlive(first + size)) << "outside the range";
  EXPECT_FALSE(watch.DeleteDegenerate(state));
  watch.LabelSmall(state, first + size, first + size + 1, Everywhere);
  EXPECT_TRUE(watch.DeleteDegenerate(state));
}

TEST(ComponentWatch, SkipsCertainlyLargeComponents)
{
  const IndexedSurface large = Ball({ 0, 0, 0 }, 12);
  Scene state({ large, Ball({ 30, 0, 0 }, 0.8) });
  const int size = static_cast<int>(large.Points.size());
  SurfaceComponents components;
  EXPECT_FALSE(components.Large().Has(state.Component[0])) << "not labelled yet";
  components.Label(state, OnThisThread());
  EXPECT_TRUE(components.Large().Has(0));
  EXPECT_FALSE(components.Large().Has(1));
  EXPECT_FALSE(components.Large().Has(2));
  EXPECT_FALSE(components.Large().Has(NoVertex));
  EXPECT_FALSE(components.Large().Has(SurfaceState::Unlabelled));
  state.FieldValue.Fill(-1.f);
  ComponentWatch watch;
  watch.LabelSmall(state, 0, state.Mesh.Size(), Everywhere, components.Large());
  EXPECT_TRUE(watch.DeleteDegenerate(state));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), size);

  EditCounts edits;
  edits.Merges = 20;
  edits.Collapses = size - ComponentWatch::SmallSize - 1 - 2 * edits.Merges;
  EXPECT_TRUE(components.Large().After(edits).Has(0));
  components.Note(edits);
  EXPECT_TRUE(components.Large().Has(0));
  EditCounts more;
  more.Collapses = 1;
  EXPECT_FALSE(components.Large().After(more).Has(0)) << "all collapses may belong to it";
  components.Label(state, OnThisThread());
  EXPECT_TRUE(components.Large().Has(0));
  EditCounts cut;
  cut.Cuts = 1;
  components.Note(cut);
  EXPECT_FALSE(components.Large().Has(0)) << "a cut may have split it";
}

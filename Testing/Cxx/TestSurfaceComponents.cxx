// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/Executor.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "Core/Surface/ComponentWatch.h"
#include "Core/Surface/SurfaceComponents.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
const Box Everywhere{ Vector(-1e9f, -1e9f, -1e9f), Vector(1e9f, 1e9f, 1e9f) };

IndexedSurface Ball(const Point& centre, double radius, bool isCavity = false)
{
  const IndexedSurface ball = DividedIcosahedron(centre, radius, 1.5);
  return isCavity ? InsideOut(ball) : ball;
}

/** A state with these components; delta is 1. */
void Fill(SurfaceState& state, const std::vector<IndexedSurface>& components)
{
  for (const IndexedSurface& component : components)
  {
    state.Mesh.Append(component);
  }
  state.Sizing = SizingField(1);
  state.Reset(Vector(-40, -40, -40), Vector(60, 40, 40));
}
}

TEST(SurfaceComponents, KeepsCavitiesInsideAndIslandsInThem)
{
  SurfaceState state;
  Fill(state,
    { Ball({ 0, 0, 0 }, 15), Ball({ 0, 0, 0 }, 10, true), Ball({ 1, 0, 0 }, 4),
      Ball({ 30, 0, 0 }, 5) });
  SurfaceComponents components;
  EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 4);
}

TEST(SurfaceComponents, LabelsComponentsByTheirFirstVerticesInAnySpans)
{
  // Vertices of all components by turns, so that each lies in all spans.
  SurfaceState state;
  const IndexedSurface ball = DividedIcosahedron({ 0, 0, 0 }, 10, 0.3);
  Fill(state, { ball, ball, ball, Ball({ 30, 0, 0 }, 3) });
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

TEST(SurfaceComponents, WatchesSmallComponentsInAllSpans)
{
  SurfaceState state;
  Fill(state,
    { DividedIcosahedron({ 0, 0, 0 }, 10, 0.2), Icosahedron({ 30, 0, 0 }, 1),
      Icosahedron({ 40, 0, 0 }, 1) });
  ASSERT_GT(state.Mesh.Size(), 2 * 16384);
  state.FieldValue.Fill(-1.f);
  Executor threads(3);
  SurfaceComponents components;
  components.Label(state, threads);
  EXPECT_TRUE(components.DeleteDegenerate(state, OnThisThread())) << "both are on the wrong side";
  EXPECT_EQ(components.NumberOfComponents(), 1);
}

TEST(SurfaceComponents, KnowsACavityByItsWholeVolume)
{
  // A ring that has what faces its first vertex, and alone has the other sign, in the last spans.
  const IndexedSurface ring = MakeTorus({ 0, 0, 0 }, 10, 4, 500, 200);
  for (const bool isCavity : { false, true })
  {
    SurfaceState state;
    Fill(state, { isCavity ? InsideOut(ring) : ring });
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

TEST(SurfaceComponents, DeletesACavityInTheOpen)
{
  SurfaceState state;
  const IndexedSurface ball = Ball({ 0, 0, 0 }, 10);
  Fill(state, { ball, Ball({ 20, 0, 0 }, 3, true), Ball({ -20, 3, 1 }, 3, true) });
  SurfaceComponents components;
  EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 1);
  EXPECT_EQ(state.Mesh.NumberOfVertices(), static_cast<int>(ball.Points.size()));
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

TEST(SurfaceComponents, DeletesAnIslandWithinTheObject)
{
  SurfaceState state;
  Fill(state, { Ball({ 0, 0, 0 }, 15), Ball({ 2, 1, 3 }, 4) });
  SurfaceComponents components;
  EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 1);
}

TEST(SurfaceComponents, KeepsTheGoodThatLieInTheInverted)
{
  // From outside in: a ball inside out, in it a ball with a cavity in it. Only the first is wrong.
  SurfaceState state;
  const IndexedSurface good = Ball({ 1, 0, 0 }, 9);
  const IndexedSurface cavity = Ball({ 1, 1, 0 }, 4, true);
  Fill(state, { Ball({ 0, 0, 0 }, 15, true), good, cavity });
  SurfaceComponents components;
  EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 2);
  EXPECT_EQ(
    state.Mesh.NumberOfVertices(), static_cast<int>(good.Points.size() + cavity.Points.size()));
  EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread())) << "nothing wrong is left";
}

TEST(SurfaceComponents, JudgesAfreshWhatLosesItsIsland)
{
  // In the object an island, which is wrong; in the island a cavity, which is then in the object.
  SurfaceState state;
  Fill(state,
    { Ball({ 0, 0, 0 }, 15), Ball({ 0, 0, 0 }, 10), Ball({ 0, 1, 0 }, 5, true),
      Ball({ 0, 1, 0 }, 2, true) });
  SurfaceComponents components;
  EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 2) << "the outermost and the larger cavity";
  EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread()));
}

TEST(SurfaceComponents, DeletesTheOnlyComponentIfItIsInsideOut)
{
  SurfaceState state;
  Fill(state, { Ball({ 0, 0, 0 }, 8, true) });
  SurfaceComponents components;
  EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), 0);
}

TEST(SurfaceComponents, LooksThroughEdgesAndCorners)
{
  // The rays of the inner components run exactly through corners and edges of the outer one.
  IndexedSurface octahedron;
  octahedron.Points = { { 9, 0, 0 }, { -9, 0, 0 }, { 0, 9, 0 }, { 0, -9, 0 }, { 0, 0, 9 },
    { 0, 0, -9 } };
  octahedron.Triangles = { { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 }, { 2, 0, 5 },
    { 1, 2, 5 }, { 3, 1, 5 }, { 0, 3, 5 } };
  for (const double shift : { 0., 1. })
  {
    IndexedSurface cavity = InsideOut(octahedron);
    for (Point& p : cavity.Points)
    {
      p = { p[0] / 9., p[1] / 9. + shift, p[2] / 9. };
    }
    SurfaceState state;
    Fill(state, { octahedron, cavity });
    SurfaceComponents components;
    EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread())) << shift;
    EXPECT_EQ(components.NumberOfComponents(), 2);
  }
}

TEST(SurfaceComponents, DeletesSmallOnesAndKeepsCount)
{
  SurfaceState state;
  Fill(state, { Ball({ 0, 0, 0 }, 10), Ball({ 30, 0, 0 }, 1) });
  SurfaceComponents components;
  components.Label(state, OnThisThread());
  ASSERT_EQ(components.NumberOfComponents(), 2);
  EXPECT_FALSE(components.DeleteDegenerate(state, OnThisThread())) << "no reason yet";
  // Wholly in the background, and tiny.
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    state.FieldValue[v] = state.Mesh.Position[v].X > 20 ? -1.f : 0.f;
  }
  const bool deleted = components.DeleteDegenerate(state, OnThisThread());
  EXPECT_TRUE(deleted);
  EXPECT_EQ(components.NumberOfComponents(), 1);
  components.Label(state, OnThisThread());
  EXPECT_EQ(components.NumberOfComponents(), 1) << "counted afresh";
  EXPECT_EQ(DescribeBrokenInvariant(state.Mesh), "");
}

namespace
{
/** Whether a ball, or a cavity, of so many vertices is deleted where the field is so. */
bool IsDeleted(double edge, double value, bool isCavity)
{
  SurfaceState state;
  const IndexedSurface ball = DividedIcosahedron({ 30, 0, 0 }, 2, edge);
  Fill(state, { Ball({ 0, 0, 0 }, 10), isCavity ? InsideOut(ball) : ball });
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

TEST(SurfaceComponents, DeletesTinyOnesWhollyOnTheWrongSide)
{
  constexpr double tiny = 3;   // 12 vertices
  constexpr double larger = 2; // 32 vertices
  EXPECT_TRUE(IsDeleted(tiny, -1, false)) << "an island in the background";
  EXPECT_FALSE(IsDeleted(tiny, 1, false)) << "an island of the object";
  EXPECT_TRUE(IsDeleted(tiny, 1, true)) << "a cavity in the object";
  EXPECT_FALSE(IsDeleted(tiny, -1, true)) << "a cavity of the background";
  EXPECT_FALSE(IsDeleted(larger, -1, false)) << "it may still reach the object";
  EXPECT_FALSE(IsDeleted(larger, 1, true));
}

TEST(SurfaceComponents, DeletesWhatHasHardlyAnyVertices)
{
  SurfaceState state;
  IndexedSurface tetrahedron;
  tetrahedron.Points = { { 30, 0, 0 }, { 32, 0, 0 }, { 30, 2, 0 }, { 30, 0, 2 } };
  tetrahedron.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  Fill(state, { Ball({ 0, 0, 0 }, 10), tetrahedron });
  SurfaceComponents components;
  components.Label(state, OnThisThread());
  EXPECT_TRUE(components.DeleteDegenerate(state, OnThisThread()));
  EXPECT_EQ(components.NumberOfComponents(), 1);
}

TEST(SurfaceComponents, LabelsComponentsOfManySpans)
{
  // Vertices are labelled in spans side by side; these components lie across several.
  SurfaceState state;
  state.Mesh.Append(DividedIcosahedron({ 0, 0, 0 }, 10, 0.3));
  state.Mesh.Append(DividedIcosahedron({ 30, 0, 0 }, 10, 0.3));
  ASSERT_GT(state.Mesh.Size(), 40000);
  state.Sizing = SizingField(1);
  state.Reset(Vector(-40, -40, -40), Vector(60, 40, 40));
  SurfaceComponents components;
  components.Label(state, OnThisThread());
  EXPECT_EQ(components.NumberOfComponents(), 2);
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    ASSERT_EQ(state.Component[v], state.Mesh.Position[v].X < 15 ? 0 : 1);
  }
}

TEST(ComponentWatch, DeletesWhatHasPassedThroughItself)
{
  SurfaceState state;
  const IndexedSurface large = Ball({ 0, 0, 0 }, 10);
  Fill(state, { large, Ball({ 30, 0, 0 }, 4) });
  ComponentWatch watch;
  watch.LabelSmall(state, 0, state.Mesh.Size(), Everywhere);
  for (const float size : { 0.2f, -0.2f })
  {
    for (int v = static_cast<int>(large.Points.size()); v < state.Mesh.Size(); ++v)
    {
      const Vector way = Normalized(state.Mesh.Position[v] - Vector(30, 0, 0));
      state.MoveTo(v, Vector(30, 0, 0) + way * (size > 0 ? size : -0.4f));
    }
    EXPECT_EQ(watch.DeleteDegenerate(state), size < 0) << "its volume has changed sign";
  }
  EXPECT_EQ(state.Mesh.NumberOfVertices(), static_cast<int>(large.Points.size()));
}

TEST(ComponentWatch, WatchesTheSmallOnesOfARangeOnly)
{
  SurfaceState state;
  const IndexedSurface large = Ball({ 0, 0, 0 }, 12);
  const IndexedSurface speck = Ball({ 30, 0, 0 }, 0.8);
  Fill(state, { large, speck, Ball({ 40, 0, 0 }, 0.8) });
  const int first = static_cast<int>(large.Points.size());
  const int size = static_cast<int>(speck.Points.size());
  ASSERT_GT(first, 800);
  ASSERT_LE(size, 24);
  state.FieldValue.Fill(-1.f); // All of the wrong side.
  ComponentWatch watch;
  // One vertex of the first speck, and all of the large one, from which the search ends early.
  for (int round = 0; round < 2; ++round)
  {
    watch.LabelSmall(state, 0, first + 1, Everywhere);
  }
  const int before = state.Mesh.NumberOfVertices();
  EXPECT_TRUE(watch.DeleteDegenerate(state));
  EXPECT_EQ(state.Mesh.NumberOfVertices(), before - size);
  EXPECT_FALSE(state.Mesh.IsAlive(first));
  EXPECT_TRUE(state.Mesh.IsAlive(first + size)) << "not in the range";
  EXPECT_FALSE(watch.DeleteDegenerate(state));
  watch.LabelSmall(state, first + size, first + size + 1, Everywhere);
  EXPECT_TRUE(watch.DeleteDegenerate(state));
}

TEST(ComponentWatch, KeepsASmallOneOnTheRightSide)
{
  SurfaceState state;
  Fill(state, { Ball({ 0, 0, 0 }, 0.8) });
  state.FieldValue.Fill(1.f);
  ComponentWatch watch;
  watch.LabelSmall(state, 0, 1, Everywhere);
  EXPECT_FALSE(watch.DeleteDegenerate(state));
  // Turned inside out since: its volume has changed its sign.
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    state.Mesh.Position[v] = state.Mesh.Position[v] * -1.f;
  }
  EXPECT_TRUE(watch.DeleteDegenerate(state));
}

TEST(ComponentWatch, NeedsNoTestOfComponentsThatAreCertainToBeLarge)
{
  SurfaceState state;
  const IndexedSurface large = Ball({ 0, 0, 0 }, 12);
  Fill(state, { large, Ball({ 30, 0, 0 }, 0.8) });
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
  EXPECT_FALSE(components.Large().After(more).Has(0)) << "all collapses may be its own";
  components.Label(state, OnThisThread());
  EXPECT_TRUE(components.Large().Has(0));
  EditCounts cut;
  cut.Cuts = 1;
  components.Note(cut);
  EXPECT_FALSE(components.Large().Has(0)) << "it may be in two";
}

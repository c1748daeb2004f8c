// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// What ranks that have parts of a surface say of its components, against what one says that has all.
#include "Core/Common/StandardThreads.h"
#include "RankTestTools.h"
#include "RemeshTestTools.h"
#include "ThreadRanks.h"

using namespace volumic;

namespace
{
constexpr float Halo = 4;
const Vector Low(-30, -30, -30);
const Vector High(70, 70, 70);

IndexedSurface Ball(const Point& centre, double radius, bool isCavity = false)
{
  const IndexedSurface ball = DividedIcosahedron(centre, radius, 1.6);
  return isCavity ? InsideOut(ball) : ball;
}

/** Components of all sizes, inside each other and side by side, with their vertices mixed. */
struct Scene
{
  SurfaceState State;
  SequentialExecutor Alone;

  explicit Scene(const std::vector<IndexedSurface>& components)
  {
    for (const IndexedSurface& component : components)
    {
      this->State.Mesh.Append(component);
    }
    std::vector<int> order(this->State.Mesh.Position.size());
    std::iota(order.begin(), order.end(), 0);
    unsigned int random = 1;
    for (std::size_t i = order.size(); i > 1; --i)
    {
      random = random * 1664525u + 1013904223u;
      std::swap(order[i - 1], order[(random >> 8) % i]);
    }
    this->State.Mesh.Reorder(order);
    this->State.Sizing = SizingField(1);
    this->State.Reset(Low, High);
    std::vector<int> all(order.size());
    std::iota(all.begin(), all.end(), 0);
    this->State.UpdateShape(all, this->Alone);
  }

  /** Calls work(ranks, part, state) on so many ranks, cut in several ways. */
  template <typename Work>
  void OnRanks(const Work& work)
  {
    const std::vector<OwnerOf> cuts = { ByCubes(this->State, 7), ByTurns(), AllOf(1) };
    for (const int count : { 1, 2, 3, 4 })
    {
      for (std::size_t cut = 0; cut < cuts.size(); ++cut)
      {
        SCOPED_TRACE(std::to_string(count) + " ranks, cut " + std::to_string(cut));
        ThreadRanks::Run(count,
          [&](Communicator& ranks)
          {
            SurfaceState part;
            TakePart(part, this->State, cuts[cut], ranks, Halo, Low, High);
            const RankPiece own = PartOf(ranks, cuts[cut]);
            work(own, part);
          });
      }
    }
  }
};

std::vector<IndexedSurface> Nested()
{
  return { Ball({ 0, 0, 0 }, 15), Ball({ 0, 0, 0 }, 10, true), Ball({ 1, 0, 0 }, 4),
    Ball({ 30, 0, 0 }, 9), Ball({ 31, 2, 0 }, 5), Ball({ 30, 30, 0 }, 6, true),
    Ball({ 30, 30, 1 }, 2), Ball({ 30, 0, 30 }, 1), Ball({ 3, 40, 30 }, 8),
    Ball({ 3, 41, 30 }, 4, true), MakeTorus({ 50, 50, 50 }, 12, 4, 50, 18),
    Ball({ 55, 30, 0 }, 9) }; // Beside the cavity in the open, whose ray it lets out again.
}

/** What there is of the surface, by index; of ranks what they own. */
std::vector<int> AliveOnes(const SurfaceState& state, const RankPiece* part = nullptr)
{
  std::vector<int> alive;
  for (int v = 0; v < state.Mesh.Size(); ++v)
  {
    if (state.Mesh.IsAlive(v) && (!part || part->IsOwn(v)))
    {
      alive.push_back(v);
    }
  }
  return alive;
}

int SumOf(Communicator& ranks, int value)
{
  const std::vector<int> values = GatherValues(ranks, value);
  return std::accumulate(values.begin(), values.end(), 0);
}

/** Whether all that is left is what is left of the whole, and counted in the same way. */
void ExpectSame(const SurfaceState& expected, const RankPiece& part, const SurfaceState& state,
  int eulerCharacteristicBefore)
{
  const std::vector<int> alive = AliveOnes(expected);
  const std::set<int> isAlive(alive.begin(), alive.end());
  for (const int v : AliveOnes(state))
  {
    EXPECT_EQ(isAlive.count(v), 1u) << v << " is left, perhaps another rank's";
  }
  EXPECT_EQ(SumOf(part.Ranks, static_cast<int>(AliveOnes(state, &part).size())),
    static_cast<int>(alive.size()));
  EXPECT_EQ(eulerCharacteristicBefore + SumOf(part.Ranks, state.EulerCharacteristic),
    expected.EulerCharacteristic);
  EXPECT_EQ(state.Counts.Removed, expected.Counts.Removed);
  EXPECT_EQ(state.Counts.RemovedGenus, expected.Counts.RemovedGenus);
}
}

TEST(SurfaceComponentsOnRanks, AreLabelledAsOnOne)
{
  Scene scene(Nested());
  SurfaceState& whole = scene.State;
  SurfaceComponents ofAll = OfAll();
  ofAll.Label(whole, scene.Alone);
  ASSERT_EQ(ofAll.NumberOfComponents(), 12);
  scene.OnRanks(
    [&](const RankPiece& part, SurfaceState& state)
    {
      StandardThreads threads(2);
      SurfaceComponents components(part);
      components.Label(state, threads);
      EXPECT_EQ(components.NumberOfComponents(), 12);
      for (int v = 0; v < state.Mesh.Size(); ++v)
      {
        if (state.Mesh.IsAlive(v) && part.IsOwn(v))
        {
          EXPECT_EQ(state.Component[v], whole.Component[v]) << v;
        }
      }
    });
}

TEST(SurfaceComponentsOnRanks, AreFoundThatAreInsideOut)
{
  Scene scene(Nested());
  SurfaceComponents ofAll = OfAll();
  ofAll.Label(scene.State, scene.Alone);
  const std::vector<int> expected = ofAll.FindInsideOut(scene.State, scene.Alone);
  ASSERT_EQ(expected.size(), 2u) << "an island in the object, a cavity in the open";
  scene.OnRanks(
    [&](const RankPiece& part, SurfaceState& state)
    {
      StandardThreads threads(2);
      SurfaceComponents components(part);
      components.Label(state, threads);
      EXPECT_EQ(components.FindInsideOut(state, threads), expected);
    });
}

TEST(SurfaceComponentsOnRanks, AreDeletedThatAreInsideOut)
{
  Scene scene(Nested());
  const int before = scene.State.EulerCharacteristic;
  Scene expected(Nested());
  ASSERT_TRUE(OfAll().DeleteInsideOut(expected.State, expected.Alone));
  scene.OnRanks(
    [&](const RankPiece& part, SurfaceState& state)
    {
      SurfaceComponents components(part);
      const int all = state.Mesh.NumberOfVertices();
      const std::size_t own = AliveOnes(state, &part).size();
      EXPECT_TRUE(components.DeleteInsideOut(state, OnThisThread()));
      EXPECT_EQ(components.NumberOfComponents(), 10);
      EXPECT_EQ(all - state.Mesh.NumberOfVertices(),
        static_cast<int>(own - AliveOnes(state, &part).size()))
        << "each place is its owner's to give away";
      ExpectSame(expected.State, part, state, before);
      for (const int v : AliveOnes(state, &part))
      {
        EXPECT_EQ(state.Component[v], expected.State.Component[v]);
      }
      EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread())) << "nothing wrong is left";
    });
}

TEST(SurfaceComponentsOnRanks, AreDeletedThatAreSmallAndMustGo)
{
  IndexedSurface tetrahedron;
  tetrahedron.Points = { { 30, 30, 30 }, { 32, 30, 30 }, { 30, 32, 30 }, { 30, 30, 32 } };
  tetrahedron.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } };
  const std::vector<IndexedSurface> components = { Ball({ 0, 0, 0 }, 15),
    DividedIcosahedron({ 30, 0, 0 }, 2, 3), DividedIcosahedron({ 30, 10, 0 }, 2, 3),
    InsideOut(DividedIcosahedron({ 30, 20, 0 }, 2, 3)), DividedIcosahedron({ 30, 30, 0 }, 2, 2),
    tetrahedron };
  const auto setField = [](SurfaceState& state)
  {
    for (int v = 0; v < state.Mesh.Size(); ++v)
    {
      state.FieldValue[v] = state.Mesh.Position[v].Y > 5 ? 1.f : -1.f;
    }
  };
  Scene scene(components);
  setField(scene.State);
  Scene expected(components);
  setField(expected.State);
  SurfaceComponents ofAll = OfAll();
  ofAll.Label(expected.State, expected.Alone);
  ASSERT_TRUE(ofAll.DeleteDegenerate(expected.State));
  ASSERT_EQ(ofAll.NumberOfComponents(), 3) << "of four points, or tiny and on the wrong side";
  const int before = scene.State.EulerCharacteristic;
  scene.OnRanks(
    [&](const RankPiece& part, SurfaceState& state)
    {
      SurfaceComponents ofRanks(part);
      ofRanks.Label(state, OnThisThread());
      EXPECT_TRUE(ofRanks.DeleteDegenerate(state));
      EXPECT_EQ(ofRanks.NumberOfComponents(), 3);
      ExpectSame(expected.State, part, state, before);
      EXPECT_FALSE(ofRanks.DeleteDegenerate(state)) << "the others may stay";
      EXPECT_EQ(ofRanks.NumberOfComponents(), 3);
    });
}

TEST(SurfaceComponentsOnRanks, OfNoSurfaceAreNone)
{
  ThreadRanks::Run(3,
    [](Communicator& ranks)
    {
      SurfaceState state;
      const RankPiece part = PartOf(ranks, ByTurns());
      SurfaceComponents components(part);
      EXPECT_FALSE(components.DeleteInsideOut(state, OnThisThread()));
      EXPECT_FALSE(components.DeleteDegenerate(state));
      EXPECT_EQ(components.NumberOfComponents(), 0);
    });
}

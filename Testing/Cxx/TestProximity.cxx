// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Common/StandardThreads.h"
#include "Core/Mesh/TriangleTests.h"
#include "Core/Surface/NewFaces.h"
#include "Core/Surface/Proximity.h"
#include "CoreTestTools.h"

using namespace volumic;

namespace
{
SequentialExecutor Threads;

MeshTriangle Named(int name, const VectorD& a, const VectorD& b, const VectorD& c)
{
  return { { name, name + 1, name + 2 }, { a, b, c } };
}

struct LiveSurface : SurfaceState
{
  LiveSurface(const IndexedSurface& surface, float delta)
  {
    this->Mesh.Append(surface);
    this->Sizing = SizingField(delta);
    this->Reset(Vector(-20, -20, -20), Vector(40, 40, 40));
  }
};

std::vector<int> All(const SurfaceState& state)
{
  std::vector<int> all(state.Mesh.Size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void Add(IndexedSurface& to, const IndexedSurface& more)
{
  const int first = static_cast<int>(to.Points.size());
  to.Points.insert(to.Points.end(), more.Points.begin(), more.Points.end());
  for (const Triangle& t : more.Triangles)
  {
    to.Triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  }
}
}

TEST(TriangleTests, FindsACrossing)
{
  const MeshTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  EXPECT_TRUE(
    TrianglesIntersect(f, Named(3, { 1, 1, -1 }, { 1, 1, 1 }, { 2, 1, 1 }), 1e-9));
  EXPECT_FALSE(
    TrianglesIntersect(f, Named(3, { 3, 3, -1 }, { 3, 3, 1 }, { 4, 3, 1 }), 1e-9));
  EXPECT_FALSE(
    TrianglesIntersect(f, Named(3, { 1, 1, 1 }, { 1, 1, 2 }, { 2, 1, 1 }), 1e-9));
}

TEST(TriangleTests, CountsWhatComesNearerThanTheTolerance)
{
  const MeshTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  const MeshTriangle g = Named(3, { 1, 1, 0.001 }, { 1, 1, 1 }, { 2, 1, 1 });
  EXPECT_FALSE(TrianglesIntersect(f, g, 1e-4));
  EXPECT_TRUE(TrianglesIntersect(f, g, 1e-2));
}

TEST(TriangleTests, TellsCoplanarTrianglesApart)
{
  const MeshTriangle f = Named(0, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 });
  EXPECT_TRUE(TrianglesIntersect(f, Named(3, { 1, 1, 0 }, { 5, 1, 0 }, { 1, 5, 0 }), 1e-9));
  EXPECT_FALSE(TrianglesIntersect(f, Named(3, { 5, 5, 0 }, { 9, 5, 0 }, { 5, 9, 0 }), 1e-9));
}

TEST(TriangleTests, DoesNotStretchANeedleBeyondItsTips)
{
  // The other triangle shares a tip and lies on its far side: set off by the tolerance, the lines
  // of the needle's long edges meet a hundred lengths further.
  const float thin = 1e-6f;
  const MeshTriangle needle = { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, thin, 0 } } };
  const MeshTriangle behind = { { 0, 3, 4 },
    { { 0, 0, 0 }, { -0.25, -0.5, -0.25 }, { -0.25, 0.5, 0.25 } } };
  EXPECT_FALSE(TrianglesIntersect(needle, behind, 1e-4));
  EXPECT_FALSE(TrianglesIntersect(behind, needle, 1e-4));
  const MeshTriangle across = { { 0, 3, 4 },
    { { 0, 0, 0 }, { 0.25, -0.5, -0.25 }, { 0.25, 0.5, 0.25 } } };
  EXPECT_TRUE(TrianglesIntersect(needle, across, 1e-4));
  // All corners on one line.
  const MeshTriangle line = { { 0, 1, 2 }, { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0, 0 } } };
  EXPECT_FALSE(TrianglesIntersect(line, behind, 1e-4));
}

TEST(TriangleTests, FindsACrossingWhicheverHasTheEdge)
{
  // The second pierces the first with an edge; seen from the second, no edge of its own is met.
  const MeshTriangle large = Named(0, { -9, -9, 0 }, { 9, -9, 0 }, { 0, 9, 0 });
  const MeshTriangle small = Named(3, { 0, 0, -1 }, { 0, 0, 1 }, { 1, 0, 1 });
  EXPECT_TRUE(TrianglesIntersect(large, small, 1e-9));
  EXPECT_TRUE(TrianglesIntersect(small, large, 1e-9));
}

TEST(TriangleTests, FindsOneTriangleWithinTheOtherInAPlane)
{
  // However the plane lies: the flat test leaves one coordinate out.
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto turned = [axis](double a, double b)
    {
      return axis == 0 ? VectorD(0, a, b) : (axis == 1 ? VectorD(b, 0, a) : VectorD(a, b, 0));
    };
    const MeshTriangle large = Named(0, turned(-9, -9), turned(9, -9), turned(0, 9));
    const MeshTriangle small = Named(3, turned(0, 0), turned(1, 0), turned(0, 1));
    EXPECT_TRUE(TrianglesIntersect(large, small, 1e-9)) << axis;
    EXPECT_TRUE(TrianglesIntersect(small, large, 1e-9)) << axis;
    const MeshTriangle beside = Named(3, turned(8, 8), turned(9, 8), turned(8, 9));
    EXPECT_FALSE(TrianglesIntersect(large, beside, 1e-9)) << axis;
  }
}

TEST(TriangleTests, FindsAFoldWhicheverWayFacesAreOriented)
{
  const VectorD a(0, 0, 0);
  const VectorD b(4, 0, 0);
  const MeshTriangle f = { { 0, 1, 2 }, { a, b, { 0, 4, 0 } } };
  for (const double side : { 1., -1. })
  {
    const VectorD c(1, 3 * side, 0.001);
    EXPECT_EQ(TrianglesIntersect(f, { { 1, 0, 3 }, { b, a, c } }, 1e-9), side > 0.);
    EXPECT_EQ(TrianglesIntersect(f, { { 0, 1, 3 }, { a, b, c } }, 1e-9), side > 0.);
    EXPECT_EQ(TrianglesIntersect(f, { { 3, 0, 1 }, { c, a, b } }, 1e-9), side > 0.);
  }
}

TEST(TriangleTests, AllowsSharedCornersAndEdgesOnly)
{
  const MeshTriangle f = { { 0, 1, 2 }, { { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } } };
  // A common edge, flat and folded.
  EXPECT_FALSE(
    TrianglesIntersect(f, { { 1, 3, 2 }, { { 4, 0, 0 }, { 4, 4, 0 }, { 0, 4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesIntersect(f, { { 1, 3, 2 }, { { 4, 0, 0 }, { 1, 1, 0 }, { 0, 4, 0 } } }, 1e-9));
  // A common corner, beside and through.
  EXPECT_FALSE(
    TrianglesIntersect(f, { { 0, 3, 4 }, { { 0, 0, 0 }, { -4, 0, 0 }, { 0, -4, 0 } } }, 1e-9));
  EXPECT_TRUE(
    TrianglesIntersect(f, { { 0, 3, 4 }, { { 0, 0, 0 }, { 2, 2, 1 }, { 1, 1, -1 } } }, 1e-9));
}

TEST(Proximity, FindsNothingOnASmoothSphere)
{
  LiveSurface state(DividedIcosahedron({ 5, 5, 5 }, 8, 1.6), 1);
  const std::vector<int> all = All(state);
  state.UpdateShape(all, Threads);
  Proximity proximity;
  proximity.Examine(state, all, OnThisThread());
  EXPECT_TRUE(proximity.Pairs().empty());
  EXPECT_TRUE(proximity.Intersections().empty());
  EXPECT_EQ(
    std::count(state.NearOthers.AsVector().begin(), state.NearOthers.AsVector().end(), 1), 0);
}

TEST(Proximity, FindsThePairsOfTwoSpheresAsBruteForceDoes)
{
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
  const int second = static_cast<int>(surface.Points.size());
  Add(surface, DividedIcosahedron({ 12.8, 0, 0 }, 6, 1.6));
  LiveSurface state(surface, 1);
  const std::vector<int> all = All(state);
  state.UpdateShape(all, Threads);
  Proximity proximity;
  proximity.Examine(state, all, OnThisThread());
  std::set<std::pair<int, int>> expected;
  for (int v = 0; v < second; ++v)
  {
    for (int w = second; w < state.Mesh.Size(); ++w)
    {
      if (SquaredDistance(state.Mesh.Position[v], state.Mesh.Position[w]) <
        SizingField::LambdaInDelta * SizingField::LambdaInDelta)
      {
        expected.insert({ v, w });
        expected.insert({ w, v });
      }
    }
  }
  ASSERT_FALSE(expected.empty());
  const auto found = [&proximity]
  {
    std::set<std::pair<int, int>> close;
    for (const Proximity::ClosePair& pair : proximity.Pairs())
    {
      if (pair.Squared < SizingField::LambdaInDelta * SizingField::LambdaInDelta)
      {
        close.insert({ pair.V, pair.W });
      }
    }
    return close;
  };
  EXPECT_EQ(found(), expected);
  proximity.Clear();
  proximity.AddPairs(state, all);
  EXPECT_EQ(found(), expected);
}

TEST(Proximity, FindsTheSameOnThreads)
{
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
  Add(surface, DividedIcosahedron({ 11., 0.3, 0.2 }, 5.5, 1.7));
  struct Found
  {
    std::vector<std::array<int, 2>> Pairs;
    std::vector<std::array<int, 3>> Faces;
    std::vector<float> Slack;
    std::vector<int> NearOthers;
  };
  const auto foundBy = [&surface](Executor& executor)
  {
    LiveSurface state(surface, 1);
    const std::vector<int> all = All(state);
    state.UpdateShape(all, executor);
    Proximity proximity;
    proximity.Examine(state, all, executor);
    Found found;
    for (const Proximity::ClosePair& pair : proximity.Pairs())
    {
      found.Pairs.push_back({ pair.V, pair.W });
    }
    for (const Proximity::FacePair& pair : proximity.Intersections())
    {
      found.Faces.insert(found.Faces.end(), { pair.First, pair.Second });
    }
    found.Slack.assign(state.Slack.AsVector().begin(), state.Slack.AsVector().end());
    found.NearOthers.assign(
      state.NearOthers.AsVector().begin(), state.NearOthers.AsVector().end());
    return found;
  };
  const Found expected = foundBy(Threads);
  ASSERT_FALSE(expected.Pairs.empty());
  ASSERT_FALSE(expected.Faces.empty());
  for (const int threads : { 2, 7 })
  {
    StandardThreads executor(threads);
    const Found found = foundBy(executor);
    EXPECT_EQ(found.Pairs, expected.Pairs) << "in their order";
    EXPECT_EQ(found.Faces, expected.Faces);
    EXPECT_EQ(found.Slack, expected.Slack);
    EXPECT_EQ(found.NearOthers, expected.NearOthers);
  }
}

TEST(Proximity, FindsWhetherTwoBodiesIntersectAtEveryDistance)
{
  for (double distance = 10.; distance < 13.; distance += 0.05)
  {
    IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
    Add(surface, DividedIcosahedron({ distance, 0.3, 0.2 }, 5.5, 1.7));
    LiveSurface state(surface, 1);
    const std::vector<int> all = All(state);
    state.UpdateShape(all, Threads);
    Proximity proximity;
    proximity.Examine(state, all, OnThisThread());
    const bool intersects = CountSelfIntersections(surface, 1) > 0;
    // The tolerance may find a touch where there is none by less than it; never the other way.
    if (intersects)
    {
      EXPECT_FALSE(proximity.Intersections().empty()) << "at distance " << distance;
    }
    else if (distance > 11.6)
    {
      EXPECT_TRUE(proximity.Intersections().empty()) << "at distance " << distance;
    }
  }
}

TEST(NewFacesIntersect, SeesWhatIsThereButNotWhatGoes)
{
  LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6), 1);
  state.UpdateShape(All(state), Threads);
  const Vector p = state.Mesh.Position[9];
  // A triangle through the surface at vertex 9.
  const VectorD n(Normalized(p));
  const VectorD side(0.1, 0.2, 0.1);
  const std::vector<MeshTriangle> through = { Named(
    1000, VectorD(p) * 1.1 + side, VectorD(p) * 0.9 + side, VectorD(p) * 0.9 + side * 2.) };
  EXPECT_TRUE(NewFacesIntersect(state, through, RemovedFaces()));
  EXPECT_FALSE(NewFacesIntersect(state, through, { { 9 }, 1, false }));
}

TEST(NewFacesIntersect, SeesNewFacesThatMeetEachOther)
{
  LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6), 1);
  state.UpdateShape(All(state), Threads);
  const MeshTriangle flat = Named(1000, { 10, 0, 0 }, { 12, 0, 0 }, { 10, 2, 0 });
  const MeshTriangle across = Named(2000, { 10.5, 0.5, -1 }, { 10.5, 0.5, 1 }, { 11, 0.5, 1 });
  const MeshTriangle beside = Named(2000, { 10.5, 0.5, 1 }, { 10.5, 0.5, 2 }, { 11, 0.5, 2 });
  EXPECT_TRUE(NewFacesIntersect(state, { flat, across }, RemovedFaces()));
  EXPECT_FALSE(NewFacesIntersect(state, { flat, beside }, RemovedFaces()));
}

TEST(NewFacesIntersect, SeesTheMiddleOfTheLargestLegalTriangle)
{
  // All its corners are lambda delta away from where a needle passes through it.
  IndexedSurface surface;
  const double lambda = SizingField::LambdaInDelta;
  for (int i = 0; i < 3; ++i)
  {
    const double a = 2 * 3.14159265358979 * i / 3;
    surface.Points.push_back({ lambda * std::cos(a), lambda * std::sin(a), 0 });
  }
  surface.Points.push_back({ 0, 0, -2 });
  surface.Triangles = { { 0, 1, 2 }, { 0, 3, 1 }, { 1, 3, 2 }, { 2, 3, 0 } };
  const LiveSurface state(surface, 1);
  const std::vector<MeshTriangle> needle = { Named(
    1000, { 0, 0, 0.3 }, { 0, 0, -0.3 }, { 0.02, 0.02, 0.3 }) };
  EXPECT_TRUE(NewFacesIntersect(state, needle, RemovedFaces()));
  const std::vector<MeshTriangle> above = { Named(
    1000, { 0, 0, 0.3 }, { 0, 0, 0.1 }, { 0.02, 0.02, 0.3 }) };
  EXPECT_FALSE(NewFacesIntersect(state, above, RemovedFaces()));
}

TEST(NewFacesIntersect, OfAnEdgeTakesAwayTheTwoFacesOnly)
{
  RemovedFaces edge{ { 4, 5 }, 2, true };
  EXPECT_TRUE(edge.Contains({ 4, 5, 6 }));
  EXPECT_TRUE(edge.Contains({ 5, 9, 4 }));
  EXPECT_FALSE(edge.Contains({ 4, 6, 7 }));
  RemovedFaces stars{ { 4, 5 }, 2, false };
  EXPECT_TRUE(stars.Contains({ 4, 6, 7 }));
  EXPECT_FALSE(stars.Contains({ 8, 6, 7 }));
}

TEST(Proximity, ToldRoomIsThere)
{
  // However two balls lie: while neither has moved by half of its slack they do not intersect.
  for (double distance = 12.2; distance < 13.6; distance += 0.1)
  {
    IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
    const int second = static_cast<int>(surface.Points.size());
    Add(surface, DividedIcosahedron({ distance, 0.3, 0.2 }, 6, 1.7));
    LiveSurface state(surface, 1);
    const std::vector<int> all = All(state);
    state.UpdateShape(all, Threads);
    Proximity proximity;
    proximity.Examine(state, all, OnThisThread());
    if (!proximity.Intersections().empty())
    {
      continue;
    }
    // The stars that have least room come nearer to each other by all but what they are told.
    for (int v = 0; v < second; ++v)
    {
      for (int w = second; w < state.Mesh.Size(); ++w)
      {
        const float room = std::min(state.Slack[v], state.Slack[w]);
        if (SquaredDistance(state.Mesh.Position[v], state.Mesh.Position[w]) > 4 || room <= 0)
        {
          continue;
        }
        IndexedSurface moved;
        const auto addStar = [&](int centre, double way)
        {
          const Ring& ring = state.Mesh.Rings[centre];
          for (int i = 0; i < ring.Count; ++i)
          {
            const int n = static_cast<int>(moved.Points.size());
            for (int x : { centre, ring.Item[i], ring.Next(i) })
            {
              const Vector& p = state.Mesh.Position[x];
              moved.Points.push_back({ p.X + way, p.Y, p.Z });
            }
            moved.Triangles.push_back({ n, n + 1, n + 2 });
          }
        };
        addStar(v, 0.499 * room);
        const std::size_t first = moved.Triangles.size();
        addStar(w, -0.499 * room);
        for (std::size_t i = 0; i < first; ++i)
        {
          for (std::size_t j = first; j < moved.Triangles.size(); ++j)
          {
            const auto named = [&moved](std::size_t t)
            {
              MeshTriangle triangle;
              for (int k = 0; k < 3; ++k)
              {
                const Point& p = moved.Points[moved.Triangles[t][k]];
                triangle.Vertex[k] = moved.Triangles[t][k];
                triangle.Corner[k] = VectorD(p[0], p[1], p[2]);
              }
              return triangle;
            };
            ASSERT_FALSE(TrianglesIntersect(named(i), named(j), 1e-9))
              << "at distance " << distance;
          }
        }
      }
    }
  }
}

TEST(Proximity, KeepsPairsOfVerticesThatWereNotExaminedAnew)
{
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
  const int second = static_cast<int>(surface.Points.size());
  Add(surface, DividedIcosahedron({ 12.8, 0, 0 }, 6, 1.6));
  LiveSurface state(surface, 1);
  const std::vector<int> all = All(state);
  state.UpdateShape(all, Threads);
  Proximity proximity;
  proximity.Examine(state, all, OnThisThread());
  const std::size_t pairs = proximity.Pairs().size();
  ASSERT_GT(pairs, 3u);
  for (const Proximity::ClosePair& pair : proximity.Pairs())
  {
    EXPECT_EQ(state.NearOthers[pair.V], 1);
    EXPECT_EQ(state.NearOthers[pair.W], 1);
    EXPECT_NE(pair.V < second, pair.W < second) << "never neighbours along the surface";
  }
  proximity.Examine(state, { 0 }, OnThisThread());
  EXPECT_EQ(proximity.Pairs().size(), pairs);
  proximity.Examine(state, all, OnThisThread());
  EXPECT_EQ(proximity.Pairs().size(), pairs);
}

TEST(Proximity, NeighboursAcrossACreaseAreNoPair)
{
  // Edges under lambda delta whose ends look in very different directions.
  IndexedSurface octahedron;
  const double r = 1.2 / std::sqrt(2.);
  octahedron.Points = { { r, 0, 0 }, { -r, 0, 0 }, { 0, r, 0 }, { 0, -r, 0 }, { 0, 0, r },
    { 0, 0, -r } };
  octahedron.Triangles = { { 0, 2, 4 }, { 2, 1, 4 }, { 1, 3, 4 }, { 3, 0, 4 }, { 2, 0, 5 },
    { 1, 2, 5 }, { 3, 1, 5 }, { 0, 3, 5 } };
  LiveSurface state(octahedron, 1);
  state.UpdateShape(All(state), Threads);
  ASSERT_TRUE(state.AreOpposed(0, 2));
  Proximity proximity;
  proximity.Examine(state, All(state), OnThisThread());
  EXPECT_TRUE(proximity.Pairs().empty());
  EXPECT_EQ(state.NearOthers[0], 1) << "though something else is near";
}

TEST(Proximity, FindsAStarThatIsFoldedOntoItself)
{
  // A vertex pushed through the faces on the far side of its own star.
  LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6), 1);
  const std::vector<int> all = All(state);
  const int v = 40;
  const Ring& ring = state.Mesh.Rings[v];
  const Vector p = state.Mesh.Position[v];
  // The neighbour is laid over the centre and beyond the opposite edge of the star.
  const Vector q = state.Mesh.Position[ring.Item[0]];
  state.MoveTo(ring.Item[0], p + (p - q) * 0.6f + Normalized(p) * 0.05f);
  state.UpdateShape(all, Threads);
  ASSERT_GT(CountSelfIntersections(state.Mesh.ToIndexed(), 1), 0);
  Proximity proximity;
  proximity.Examine(state, all, OnThisThread());
  EXPECT_FALSE(proximity.Intersections().empty());
  for (const Proximity::FacePair& pair : proximity.Intersections())
  {
    for (const std::array<int, 3>& face : { pair.First, pair.Second })
    {
      for (int corner : face)
      {
        EXPECT_EQ(state.Slack[corner], 0) << "no room";
      }
    }
  }
}

TEST(Proximity, FindsLargeFacesFromTheSmallOnesThatTheyCross)
{
  // A small ball that a face of a large one cuts, whose corners are far from it.
  const IndexedSurface large = DividedIcosahedron({ 0., 0., 0. }, 15., 6.);
  const int larges = static_cast<int>(large.Points.size());
  const Triangle& cut = large.Triangles.front();
  Point middle{};
  for (int axis = 0; axis < 3; ++axis)
  {
    middle[axis] = (large.Points[cut[0]][axis] + large.Points[cut[1]][axis] +
                     large.Points[cut[2]][axis]) / 3.;
  }
  IndexedSurface both = large;
  Add(both, DividedIcosahedron(middle, 1.2, 0.8));
  LiveSurface s(both, 0.5f);
  LargeVector<float> sizes(s.Mesh.Rings.size(), 0.5f);
  std::fill(sizes.begin(), sizes.begin() + larges, 4.f);
  s.Sizing = s.Sizing.Graded(sizes, 4.f, 1.f);
  s.UpdateShape(All(s), Threads);
  std::vector<int> smalls = All(s);
  smalls.erase(smalls.begin(), smalls.begin() + larges);
  const std::size_t ofAll = Proximity::FindIntersections(s, All(s), Threads).size();
  EXPECT_GT(ofAll, 3u);
  EXPECT_EQ(Proximity::FindIntersections(s, smalls, Threads).size(), ofAll);
}

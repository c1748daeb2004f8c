// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"
#include "Core/Surface/Proximity.h"
#include "LiveSurface.h"

using namespace volumic;

TEST(Proximity, FindsSamePairsAsBruteForce)
{
  IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
  const int second = static_cast<int>(surface.Points.size());
  AddSurface(surface, DividedIcosahedron({ 12.8, 0, 0 }, 6, 1.6));
  LiveSurface state(surface);
  constexpr float lambdaSquared = SizingField::LambdaInDelta * SizingField::LambdaInDelta;
  std::set<std::pair<int, int>> expected;
  for (int v = 0; v < second; ++v)
  {
    for (int w = second; w < state.Mesh.Size(); ++w)
    {
      if (SquaredDistance(state.Mesh.Position[v], state.Mesh.Position[w]) < lambdaSquared)
      {
        expected.insert({ v, w });
        expected.insert({ w, v });
      }
    }
  }
  ASSERT_GT(expected.size(), 3u);
  Proximity proximity;
  const auto found = [&]
  {
    std::set<std::pair<int, int>> close;
    for (const Proximity::ClosePair& pair : proximity.Pairs())
    {
      EXPECT_NE(pair.V < second, pair.W < second) << "pairs must not be neighbours on the surface";
      EXPECT_TRUE(state.NearOthers[pair.V] && state.NearOthers[pair.W]);
      if (pair.Squared < lambdaSquared)
      {
        EXPECT_TRUE(close.insert({ pair.V, pair.W }).second) << "listed twice";
      }
    }
    return close;
  };
  proximity.Test(state, state.All(), OnThisThread());
  EXPECT_EQ(found(), expected);
  proximity.Test(state, { 0 }, OnThisThread());
  EXPECT_EQ(found(), expected) << "pairs of vertices that were not tested are kept";
  proximity.Test(state, state.All(), OnThisThread());
  EXPECT_EQ(found(), expected);
  proximity.Clear();
  proximity.AddPairs(state, state.All());
  EXPECT_EQ(found(), expected);
}

TEST(Proximity, DetectsIntersectionsAtAnyDistance)
{
  for (double distance = 10.; distance < 13.; distance += 0.05)
  {
    IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
    AddSurface(surface, DividedIcosahedron({ distance, 0.3, 0.2 }, 5.5, 1.7));
    LiveSurface state(surface);
    Proximity proximity;
    proximity.Test(state, state.All(), OnThisThread());
    const bool intersects = CountSelfIntersections(surface, 1) > 0;
    // The tolerance may report additional intersections, but none is missed.
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

TEST(Proximity, ClearanceIsLowerBound)
{
  // While neither ball has moved by half of its clearance they do not intersect.
  int tested = 0;
  for (double distance = 12.2; distance < 13.6; distance += 0.1)
  {
    IndexedSurface surface = DividedIcosahedron({ 0, 0, 0 }, 6, 1.6);
    const std::size_t second = surface.Points.size();
    AddSurface(surface, DividedIcosahedron({ distance, 0.3, 0.2 }, 6, 1.7));
    LiveSurface state(surface);
    Proximity proximity;
    proximity.Test(state, state.All(), OnThisThread());
    const auto& clearance = state.ClearanceAtTest.AsVector();
    const float least = *std::min_element(clearance.begin(), clearance.end());
    if (!proximity.Intersections().empty() || least <= 0.f)
    {
      continue;
    }
    ++tested;
    for (std::size_t v = 0; v < surface.Points.size(); ++v)
    {
      surface.Points[v][0] += v < second ? 0.499 * least : -0.499 * least;
    }
    EXPECT_EQ(CountSelfIntersections(surface), 0) << "at distance " << distance;
  }
  EXPECT_GT(tested, 5);
}

TEST(NormalCone, BatchTestMatchesSingleTests)
{
  std::mt19937 random(1);
  const auto next = [&random] { return static_cast<float>(random() >> 8) / (1 << 23) - 1.f; };
  const auto cone = [&next]
  {
    const Vector axis = Normalized(Vector(next(), next(), next()));
    return NormalCone(axis, 0.8f + 0.2f * next());
  };
  int opposed = 0;
  for (int round = 0; round < 1000; ++round)
  {
    const NormalCone n = cone();
    // The last cone exceeds a half-space and is opposed to all.
    const NormalCone m[4] = { cone(), cone(), cone(), NormalCone(cone().Axis(), -0.1f) };
    const unsigned bits = OpposedBits(n, m[0], m[1], m[2], m[3]);
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_EQ(bits >> i & 1, AreOpposed(n, m[i]) ? 1u : 0u);
      opposed += AreOpposed(n, m[i]) ? 1 : 0;
    }
    EXPECT_TRUE(AreOpposed(n, m[3]));
  }
  EXPECT_GT(opposed, 1200); // Out of 4000.
  EXPECT_LT(opposed, 3500);
}

TEST(Proximity, DetectsFoldedStar)
{
  // A vertex pushed through the faces on the opposite side of its own star.
  LiveSurface state(DividedIcosahedron({ 0, 0, 0 }, 6, 1.6));
  const int v = 40;
  const Ring& ring = state.Mesh.Rings[v];
  const Vector p = state.Mesh.Position[v];
  // Move the neighbour over the centre and beyond the opposite edge of the star.
  const Vector q = state.Mesh.Position[ring.Item[0]];
  state.MoveTo(ring.Item[0], p + (p - q) * 0.6f + Normalized(p) * 0.05f);
  state.UpdateShape();
  ASSERT_GT(CountSelfIntersections(state.Mesh.ToIndexed(), 1), 0);
  Proximity proximity;
  proximity.Test(state, state.All(), OnThisThread());
  EXPECT_FALSE(proximity.Intersections().empty());
  for (const Proximity::FacePair& pair : proximity.Intersections())
  {
    for (const std::array<int, 3>& face : { pair.First, pair.Second })
    {
      for (int corner : face)
      {
        EXPECT_EQ(state.ClearanceAtTest[corner], 0) << "no clearance";
      }
    }
  }
}

TEST(Proximity, DetectsLargeFacesFromSmallOnes)
{
  // A small ball cut by a face of a large one, whose corners are far away.
  const IndexedSurface large = DividedIcosahedron({ 0., 0., 0. }, 15., 6.);
  const int larges = static_cast<int>(large.Points.size());
  const Triangle& cut = large.Triangles.front();
  Point middle{};
  for (int axis = 0; axis < 3; ++axis)
  {
    middle[axis] =
      (large.Points[cut[0]][axis] + large.Points[cut[1]][axis] + large.Points[cut[2]][axis]) / 3.;
  }
  IndexedSurface both = large;
  AddSurface(both, DividedIcosahedron(middle, 1.2, 0.8));
  LiveSurface s(both, 0.5f);
  LargeVector<float> sizes(s.Mesh.Rings.size(), 0.5f);
  std::fill(sizes.begin(), sizes.begin() + larges, 4.f);
  s.Sizing = s.Sizing.Graded(sizes, 4.f, 1.f);
  s.UpdateShape();
  std::vector<int> smalls = s.All();
  smalls.erase(smalls.begin(), smalls.begin() + larges);
  const std::size_t ofAll = Proximity::FindIntersections(s, s.All(), OnThisThread()).size();
  EXPECT_GT(ofAll, 3u);
  EXPECT_EQ(Proximity::FindIntersections(s, smalls, OnThisThread()).size(), ofAll);
}

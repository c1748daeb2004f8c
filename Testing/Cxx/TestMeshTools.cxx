// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Small tools of meshes: rows through triangles, lattices, edges that are halved, rings that are
// relieved, volumes and areas.
#include "Core/Common/Lattice.h"
#include "Core/Common/StandardThreads.h"
#include "Core/Mesh/LongEdges.h"
#include "Core/Mesh/RingRelief.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/SurfaceMeasures.h"
#include "EvolutionTestTools.h"
#include "RemeshTestTools.h"

using namespace volumic;

namespace
{
std::vector<RowCrossing> CrossingsOf(const IndexedSurface& surface, double y, double z)
{
  std::vector<RowCrossing> crossings;
  for (const Triangle& t : surface.Triangles)
  {
    const RowCrossing crossing =
      RowCrossing::Of(surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]], y, z);
    if (crossing.Winding != 0)
    {
      crossings.push_back(crossing);
    }
  }
  return crossings;
}
}

TEST(RowCrossing, TellsWhereALineEntersAndLeaves)
{
  const IndexedSurface surface = Octahedron({ 0, 0, 0 }, 4, 4, 4);
  for (const double y : { 1., -0.5 })
  {
    const std::vector<RowCrossing> crossings = CrossingsOf(surface, y, 0.25);
    ASSERT_EQ(crossings.size(), 2u);
    for (const RowCrossing& crossing : crossings)
    {
      EXPECT_EQ(crossing.Winding, crossing.X < 0 ? 1 : -1);
      EXPECT_NEAR(std::abs(crossing.X), 4 - std::abs(y) - 0.25, 1e-12);
    }
  }
  EXPECT_TRUE(CrossingsOf(surface, 3, 1.5).empty());
}

TEST(RowCrossing, CountsOnceAtEdgesAndCorners)
{
  const IndexedSurface surface = Octahedron({ 0, 0, 0 }, 4, 4, 4);
  // Through two corners, and along the planes of four edges each.
  for (const Point& p :
    std::vector<Point>{ { 0, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } })
  {
    const std::vector<RowCrossing> crossings = CrossingsOf(surface, p[1], p[2]);
    ASSERT_EQ(crossings.size(), 2u) << p[1] << " " << p[2];
    EXPECT_EQ(crossings[0].Winding + crossings[1].Winding, 0);
    EXPECT_NEAR(crossings[0].X + crossings[1].X, 0, 1e-12);
  }
  // The corners at the sides are either passed by, or entered and left at once.
  for (const Point& p : std::vector<Point>{ { 0, 4, 0 }, { 0, -4, 0 }, { 0, 0, 4 }, { 0, 0, -4 },
         { 0, 2, 2 }, { 0, -2, 2 }, { 0, 2, -2 }, { 0, -2, -2 } })
  {
    int sum = 0;
    for (const RowCrossing& crossing : CrossingsOf(surface, p[1], p[2]))
    {
      EXPECT_NEAR(crossing.X, 0, 1e-12);
      sum += crossing.Winding;
    }
    EXPECT_EQ(sum, 0) << p[1] << " " << p[2];
  }
}

TEST(RowGrid, FindsTheCrossingsOfAllItsRows)
{
  const RowGrid rows = { { 0, -2, 3 }, { 0, 9, 17 }, { 0., 0.3, -0.2 }, 0.7, 0.5 };
  std::uint32_t random = 1;
  const auto next = [&random](double size)
  {
    random = random * 1664525u + 1013904223u;
    return size * (random >> 8) / (1 << 24) - 2.;
  };
  std::size_t all = 0;
  for (int n = 0; n < 300; ++n)
  {
    std::array<Point, 3> t;
    for (Point& p : t)
    {
      p = { next(9.), next(10.), next(16.) };
    }
    if (n % 3 == 0) // a sliver
    {
      t[2] = { t[1][0] + 0.01, t[1][1] + 0.03, t[1][2] };
    }
    std::vector<RowGrid::Crossing> found;
    rows.AddCrossings(t, found);
    std::sort(found.begin(), found.end());
    auto place = found.begin();
    for (std::int64_t k = rows.First[2]; k < rows.End[2]; ++k)
    {
      for (std::int64_t j = rows.First[1]; j < rows.End[1]; ++j)
      {
        const RowCrossing wanted =
          RowCrossing::Of(t[0], t[1], t[2], rows.Coordinate(1, j), rows.Coordinate(2, k));
        if (wanted.Winding != 0)
        {
          ASSERT_NE(place, found.end());
          EXPECT_EQ(place->Row, rows.RowOf(j, k));
          EXPECT_EQ(place->Where.Winding, wanted.Winding);
          EXPECT_EQ((place++)->Where.X, wanted.X);
        }
      }
    }
    EXPECT_EQ(place, found.end());
    all += found.size();
  }
  EXPECT_GT(all, 1000u);
}

TEST(ComponentsAbout, AreThoseThatEncloseAPlaceButItsOwn)
{
  std::vector<IndexedSurface> nested;
  for (const double size : { 4., 3., 2. })
  {
    nested.push_back(Octahedron({ 0, 0, 0 }, size, size, size));
  }
  const auto facesOf = [&nested](std::size_t begin, std::size_t end, const auto& visit)
  {
    for (std::size_t component = begin; component < end; ++component)
    {
      const IndexedSurface& surface = nested[component];
      for (const Triangle& t : surface.Triangles)
      {
        visit(surface.Points[t[0]], surface.Points[t[1]], surface.Points[t[2]],
          static_cast<int>(component));
      }
    }
  };
  const std::vector<Point> places = { { 3.5, 0.1, 0.1 }, { 0, 0, 0 }, { -2.5, 0.1, 0 },
    { -9, 0.1, 0.1 }, { 0, 5, 0 } };
  using Lists = std::vector<std::vector<int>>;
  StandardThreads threads(3);
  EXPECT_EQ(ComponentsAbout(places, {}, nested.size(), facesOf, threads),
    (Lists{ { 0 }, { 0, 1, 2 }, { 0, 1 }, {}, {} }));
  EXPECT_EQ(ComponentsAbout(places, { 0, 1, 1, -1, 2 }, nested.size(), facesOf, threads),
    (Lists{ {}, { 0, 2 }, { 0 }, {}, {} }));
}

TEST(Lattice, EdgesAndTrianglesHaveKeysOfTheirOwn)
{
  std::map<std::uint64_t, std::vector<LatticePoint>> edges;
  std::map<std::uint64_t, std::vector<LatticePoint>> triangles;
  std::size_t tetrahedra = 0;
  const auto check = [](auto& known, std::uint64_t key, std::vector<LatticePoint> points)
  {
    std::sort(points.begin(), points.end());
    EXPECT_EQ(known.emplace(key, points).first->second, points);
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    ForBox({ 1, 1, 1 }, { 4, 4, 4 },
      [&](int i, int j, int k)
      {
        const LatticeEdge edge({ 2 * i, 2 * j, 2 * k }, axis);
        for (int turn = 0; turn < 4; ++turn, ++tetrahedra)
        {
          const std::array<LatticePoint, 4> corners = { edge.From, edge.To, edge.About[turn],
            edge.About[(turn + 1) % 4] };
          for (int c = 0; c < 4; ++c)
          {
            const LatticePoint& a = corners[(c + 1) % 4];
            const LatticePoint& b = corners[(c + 2) % 4];
            const LatticePoint& d = corners[(c + 3) % 4];
            check(triangles, LatticeKey(a, b, d), { a, b, d });
            check(edges, LatticeKey(a, b), { a, b });
            check(edges, LatticeKey(a, d), { a, d });
          }
        }
      });
  }
  EXPECT_EQ(tetrahedra, 3u * 27u * 4u);
  EXPECT_LT(triangles.size(), 4 * tetrahedra) << "neighbours share them";
}

TEST(HalveLongEdges, LeavesTheSurfaceWhereItIs)
{
  IndexedSurface box = Cuboid({ 0, 0, 0 }, { 16, 3, 1 });
  HalveLongEdges(box, 2.);
  const std::vector<double> lengths = EdgeLengths(box);
  EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), 2.);
  EXPECT_GT(*std::max_element(lengths.begin(), lengths.end()), 1.);
  const SurfaceFeatures after = ComputeFeatures(box);
  EXPECT_EQ(after.Components.size(), 1u);
  EXPECT_EQ(after.EulerCharacteristic, 2) << "each middle is one point of two triangles";
  EXPECT_DOUBLE_EQ(after.Volume, 48.) << "oriented as it was";
  EXPECT_DOUBLE_EQ(after.Area, 134.);
  EXPECT_EQ(CountSelfIntersections(box), 0);
}

namespace
{
/** A lens: a point above and one below two rings of so many. */
IndexedSurface Lens(int sides, double height)
{
  IndexedSurface surface;
  surface.Points = { { 0., 0., height }, { 0., 0., -height } };
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2. * 3.14159265358979 * i / sides;
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    surface.Points.push_back({ x, y, 0.1 });
    surface.Points.push_back({ x, y, -0.1 });
    const int upper = 2 + 2 * i;
    const int next = 2 + 2 * ((i + 1) % sides);
    surface.Triangles.push_back({ 0, upper, next });
    surface.Triangles.push_back({ 1, next + 1, upper + 1 });
    surface.Triangles.push_back({ upper, upper + 1, next + 1 });
    surface.Triangles.push_back({ upper, next + 1, next });
  }
  return surface;
}

int MostNeighbours(const IndexedSurface& surface)
{
  std::vector<int> valence(surface.Points.size(), 0);
  for (const Triangle& t : surface.Triangles)
  {
    for (const int corner : t)
    {
      ++valence[static_cast<std::size_t>(corner)];
    }
  }
  return *std::max_element(valence.begin(), valence.end());
}
}

TEST(RelieveRings, TakesNeighboursFromThoseThatHaveTooMany)
{
  IndexedSurface surface = Lens(22, 0.2);
  const SurfaceFeatures before = ComputeFeatures(surface);
  ASSERT_GT(MostNeighbours(surface), Ring::Capacity);
  EXPECT_TRUE(RelieveRings(surface));
  EXPECT_LE(MostNeighbours(surface), Ring::Capacity);
  const SurfaceFeatures after = ComputeFeatures(surface);
  EXPECT_EQ(after.EulerCharacteristic, 2);
  EXPECT_EQ(after.Components.size(), 1u);
  EXPECT_NEAR(after.Volume, before.Volume, 0.05 * before.Volume) << "oriented as it was";
  EXPECT_EQ(CountSelfIntersections(surface), 0);
}

TEST(RelieveRings, TellsWhereItCannot)
{
  // Needles: any other edge would fold them.
  IndexedSurface surface = Lens(22, 60.);
  EXPECT_FALSE(RelieveRings(surface));
}

namespace
{
/** A ball far from the origin, of more than one block of vertices, with a cavity. */
SurfaceMesh HollowBall()
{
  SurfaceMesh mesh;
  mesh.Append(DividedIcosahedron({ 60, 50, 40 }, 12, 0.6));
  mesh.Append(InsideOut(DividedIcosahedron({ 62, 50, 40 }, 6, 0.6)));
  return mesh;
}
}

TEST(SurfaceMeasures, AreThoseOfTheTriangles)
{
  SurfaceMesh mesh = HollowBall();
  ASSERT_GT(mesh.Size(), 4096);
  const SurfaceFeatures features = ComputeFeatures(mesh.ToIndexed());
  SequentialExecutor sequential;
  EXPECT_NEAR(EnclosedVolume(mesh, sequential), features.Volume, 1e-9 * features.Volume);
  double area = 0.;
  for (int v = 0; v < mesh.Size(); ++v)
  {
    area += AreaShare(mesh, v);
  }
  EXPECT_NEAR(area, features.Area, 1e-6 * features.Area);
}

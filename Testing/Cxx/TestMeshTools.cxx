// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "Core/Common/Executor.h"
#include "Core/Mesh/RowCrossing.h"
#include "CoreTestTools.h"

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
  // Corners at the sides are missed, or entered and left at the same x.
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

TEST(RowGrid, FindsCrossingsOfAllRows)
{
  const RowGrid rows = { { 0, -2, 3 }, { 0, 9, 17 }, { 0., 0.65, 0.15 }, 0.7 };
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
    if (n % 3 == 0) // A sliver.
    {
      t[2] = { t[1][0] + 0.01, t[1][1] + 0.03, t[1][2] };
    }
    std::vector<RowGrid::Crossing> found;
    rows.AddCrossings(t, found);
    std::sort(found.begin(), found.end());
    auto crossing = found.begin();
    for (std::int64_t k = rows.First[2]; k < rows.End[2]; ++k)
    {
      for (std::int64_t j = rows.First[1]; j < rows.End[1]; ++j)
      {
        const RowCrossing requested =
          RowCrossing::Of(t[0], t[1], t[2], rows.Coordinate(1, j), rows.Coordinate(2, k));
        if (requested.Winding != 0)
        {
          ASSERT_NE(crossing, found.end());
          EXPECT_EQ(crossing->Row, rows.RowOf(j, k));
          EXPECT_EQ(crossing->Where.Winding, requested.Winding);
          EXPECT_EQ((crossing++)->Where.X, requested.X);
        }
      }
    }
    EXPECT_EQ(crossing, found.end());
    all += found.size();
  }
  EXPECT_GT(all, 1000u);
}

TEST(EnclosingComponents, ExcludeOwnComponent)
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
  const std::vector<Point> points = { { 3.5, 0.1, 0.1 }, { 0, 0, 0 }, { -2.5, 0.1, 0 },
    { -9, 0.1, 0.1 }, { 0, 5, 0 } };
  using Lists = std::vector<std::vector<int>>;
  Executor threads(3);
  EXPECT_EQ(EnclosingComponents(points, {}, nested.size(), facesOf, threads),
    (Lists{ { 0 }, { 0, 1, 2 }, { 0, 1 }, {}, {} }));
  EXPECT_EQ(EnclosingComponents(points, { 0, 1, 1, -1, 2 }, nested.size(), facesOf, threads),
    (Lists{ {}, { 0, 2 }, { 0 }, {}, {} }));
}

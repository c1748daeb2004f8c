// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/CellSurface.h"
#include "Core/Mesh/SurfaceCheck.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "TestPrelude.h"

using namespace volumic;

namespace
{
double Distance(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** Every so-many-th cell about the origin, so that sets touch in all ways that there are. */
std::vector<CellLattice::Cell> RandomCells(double share, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0., 1.);
  std::vector<CellLattice::Cell> cells;
  for (int i = -6; i <= 6; ++i)
  {
    for (int j = -6; j <= 6; ++j)
    {
      for (int k = -6; k <= 6; ++k)
      {
        if ((i - j) % 2 == 0 && (j - k) % 2 == 0 && uniform(random) < share)
        {
          cells.push_back({ i, j, k });
        }
      }
    }
  }
  return cells; // In order by its making.
}

double Volume(const IndexedSurface& surface)
{
  return ComputeFeatures(surface).Volume;
}
}

TEST(CellSurface, PointsLieInTheCellWhoseCentreIsNearest)
{
  const CellLattice lattice(0.9);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-5., 5.);
  for (int n = 0; n < 500; ++n)
  {
    const Point p = { uniform(random), uniform(random), uniform(random) };
    const CellLattice::Cell cell = lattice.CellAt(p);
    EXPECT_TRUE((cell[0] - cell[1]) % 2 == 0 && (cell[1] - cell[2]) % 2 == 0);
    const double own = Distance(p, lattice.Centre(cell));
    EXPECT_LE(own, 0.9 * CellLattice::Circumradius);
    for (const CellLattice::Cell& other : RandomCells(1., 0))
    {
      EXPECT_LE(own, Distance(p, lattice.Centre(other)) + 1e-12);
    }
  }
}

TEST(CellSurface, AnySetOfCellsHasAClosedManifoldBoundaryWithoutIntersections)
{
  constexpr double edge = 1.;
  const CellLattice lattice(edge);
  for (double share : { 0.05, 0.2, 0.5, 0.8, 0.95 })
  {
    SCOPED_TRACE(share);
    const std::vector<CellLattice::Cell> cells =
      RandomCells(share, static_cast<unsigned>(100 * share));
    const IndexedSurface surface = lattice.Boundary(cells);
    EXPECT_NO_THROW(CheckInitialSurface(surface)) << "closed, oriented, manifold";
    EXPECT_EQ(CountSelfIntersections(surface, 1), 0);
    EXPECT_NEAR(Volume(surface), 8. * std::sqrt(2.) * static_cast<double>(cells.size()),
      1e-6 * static_cast<double>(cells.size()));
  }
}

TEST(CellSurface, EdgesAndDistancesRespectTheConstraints)
{
  const IndexedSurface surface = CellLattice(1.).Boundary(RandomCells(0.4, 3));
  std::set<std::pair<int, int>> joined;
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      joined.emplace(std::min(a, b), std::max(a, b));
      const double length = Distance(surface.Points[a], surface.Points[b]);
      EXPECT_TRUE(std::abs(length - 1.) < 1e-9 || std::abs(length - std::sqrt(2.)) < 1e-9);
    }
  }
  for (int a = 0; a < static_cast<int>(surface.Points.size()); ++a)
  {
    for (int b = a + 1; b < static_cast<int>(surface.Points.size()); ++b)
    {
      if (joined.count({ a, b }) == 0)
      {
        ASSERT_GE(Distance(surface.Points[a], surface.Points[b]), 1. - 1e-9);
      }
    }
  }
}

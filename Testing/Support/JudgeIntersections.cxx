// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceJudge.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

namespace volumic::support
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;

/** Test of a pair of triangles as in CGAL's self_intersections(), for a triangle soup. */
class SoupTest
{
public:
  explicit SoupTest(const TriangleSurface& surface) : Surface(surface) {}

  Kernel::Point_3 Corner(std::size_t t, int c) const
  {
    const std::array<double, 3>& p = this->Surface.Points[this->Surface.Triangles[t][c]];
    return { p[0], p[1], p[2] };
  }

  Kernel::Triangle_3 Triangle(std::size_t t) const
  {
    return { this->Corner(t, 0), this->Corner(t, 1), this->Corner(t, 2) };
  }

  bool Intersect(std::size_t t, std::size_t u) const
  {
    int shared = 0;
    int freeT = 0, freeU = 0;       // sum of shared corners, then corner opposite a shared edge
    int sharedT = -1, sharedU = -1; // last shared corner
    for (int c = 0; c < 3; ++c)
    {
      for (int d = 0; d < 3; ++d)
      {
        if (this->Surface.Triangles[t][c] == this->Surface.Triangles[u][d])
        {
          ++shared;
          freeT += c;
          freeU += d;
          sharedT = c;
          sharedU = d;
        }
      }
    }
    if (shared == 0)
    {
      return CGAL::do_intersect(this->Triangle(t), this->Triangle(u));
    }
    if (shared == 1)
    {
      const Kernel::Segment_3 oppositeT(
        this->Corner(t, (sharedT + 1) % 3), this->Corner(t, (sharedT + 2) % 3));
      const Kernel::Segment_3 oppositeU(
        this->Corner(u, (sharedU + 1) % 3), this->Corner(u, (sharedU + 2) % 3));
      return CGAL::do_intersect(this->Triangle(t), oppositeU) ||
        CGAL::do_intersect(this->Triangle(u), oppositeT);
    }
    if (shared == 2)
    {
      // Triangles at an edge overlap if they are coplanar and on the same side of it.
      freeT = 3 - freeT;
      freeU = 3 - freeU;
      const Kernel::Point_3 from = this->Corner(t, (freeT + 1) % 3);
      const Kernel::Point_3 to = this->Corner(t, (freeT + 2) % 3);
      const Kernel::Point_3 tipT = this->Corner(t, freeT), tipU = this->Corner(u, freeU);
      return CGAL::coplanar(from, to, tipT, tipU) &&
        CGAL::coplanar_orientation(from, to, tipT, tipU) == CGAL::POSITIVE;
    }
    return true; // duplicate triangle
  }

private:
  const TriangleSurface& Surface;
};

} // namespace

IntersectionVerdict JudgeIntersections(const TriangleSurface& surface)
{
  const SoupTest test(surface);
  IntersectionVerdict verdict;
  std::vector<Box> boxes;
  boxes.reserve(surface.Triangles.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const Kernel::Point_3 p = test.Corner(t, 0), q = test.Corner(t, 1), r = test.Corner(t, 2);
    if (CGAL::collinear(p, q, r))
    {
      ++verdict.FlatTriangles;
      continue;
    }
    boxes.emplace_back(p.bbox() + q.bbox() + r.bbox(), t);
  }
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
    [&](const Box& a, const Box& b) { verdict.Pairs += test.Intersect(a.info(), b.info()); });
  return verdict;
}
} // namespace volumic::support

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "LabelJudge.h"

#include "JudgeInternals.h"

#include <CGAL/AABB_tree.h>
#if __has_include(<CGAL/AABB_traits_3.h>) // from CGAL 6 on
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace volumic::support
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
#if __has_include(<CGAL/AABB_traits_3.h>)
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, Primitive>>;
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
#endif
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, const Kernel::Triangle_3*>;

Kernel::Point_3 CgalPoint(const std::array<double, 3>& p)
{
  return { p[0], p[1], p[2] };
}

/** Triangles without area are left out: they are part of their neighbours. */
Triangles CgalTriangles(const TriangleSurface& surface)
{
  Triangles triangles;
  triangles.reserve(surface.Triangles.size());
  for (const auto& t : surface.Triangles)
  {
    const Kernel::Triangle_3 triangle(CgalPoint(surface.Points[t[0]]),
      CgalPoint(surface.Points[t[1]]), CgalPoint(surface.Points[t[2]]));
    if (!triangle.is_degenerate())
    {
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

std::vector<Box> BoxesOf(const Triangles& triangles)
{
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const auto& triangle : triangles)
  {
    boxes.emplace_back(triangle.bbox(), &triangle);
  }
  return boxes;
}

/** How deep vertices of `one` are inside the triangles, whose surface is closed. */
void AddDepths(const TriangleSurface& one, const Triangles& other, OverlapVerdict& verdict)
{
  Tree tree(other.begin(), other.end());
  const CGAL::Bbox_3 box = tree.bbox();
  std::vector<char> used(one.Points.size(), 0);
  for (const auto& triangle : one.Triangles)
  {
    for (const int corner : triangle)
    {
      used[corner] = 1;
    }
  }
  for (std::size_t v = 0; v < one.Points.size(); ++v)
  {
    const Kernel::Point_3 p = CgalPoint(one.Points[v]);
    if (!used[v] || !CGAL::do_overlap(box, p.bbox()))
    {
      continue;
    }
    // No axis: a ray along one would meet edges and corners of what was made of voxels.
    const Kernel::Ray_3 ray(p, Kernel::Vector_3(0.38117, 0.57913, 0.72071));
    if (tree.number_of_intersected_primitives(ray) % 2 == 1)
    {
      const double depth = std::sqrt(tree.squared_distance(p));
      ++verdict.VerticesInside;
      verdict.MeanDepth += depth;
      verdict.LargestDepth = std::max(verdict.LargestDepth, depth);
    }
  }
}

} // namespace

//------------------------------------------------------------------------------
OverlapVerdict JudgeOverlap(const TriangleSurface& a, const TriangleSurface& b)
{
  CheckSurface(a);
  CheckSurface(b);
  OverlapVerdict verdict;
  const Triangles ofA = CgalTriangles(a), ofB = CgalTriangles(b);
  if (ofA.empty() || ofB.empty())
  {
    return verdict;
  }
  AddDepths(a, ofB, verdict);
  AddDepths(b, ofA, verdict);
  if (verdict.VerticesInside > 0)
  {
    verdict.MeanDepth /= static_cast<double>(verdict.VerticesInside);
  }
  std::vector<Box> boxesOfA = BoxesOf(ofA), boxesOfB = BoxesOf(ofB);
  CGAL::box_intersection_d(boxesOfA.begin(), boxesOfA.end(), boxesOfB.begin(), boxesOfB.end(),
    [&verdict](const Box& x, const Box& y)
    { verdict.IntersectingPairs += CGAL::do_intersect(*x.info(), *y.info()); });
  return verdict;
}

} // namespace volumic::support

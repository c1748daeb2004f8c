// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/SelfIntersections.h"

#include "Core/Mesh/TriangleTests.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/**
 * Triangles count as intersecting if they are nearer than this fraction of the mean edge length, or
 * of the largest coordinate. It is far less than the rounding of the points to float.
 */
constexpr double ToleranceOfEdges = 2e-9;
constexpr double ToleranceOfExtent = 1e-14;
/** Margin for rounding: the tree has exact points, the tests have points rounded to float. */
constexpr double RoundingOfExtent = 1e-6;

MeshTriangle RoundedTriangle(const IndexedSurface& surface, int i)
{
  MeshTriangle triangle;
  for (int k = 0; k < 3; ++k)
  {
    const int corner = surface.Triangles[i][k];
    const Point& p = surface.Points[corner];
    triangle.Vertex[k] = corner;
    triangle.Corner[k] =
      VectorD(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  return triangle;
}

/** Selects tree nodes that overlap the box of a triangle and are cut by its plane. */
class CandidateBox
{
public:
  CandidateBox(const MeshTriangle& triangle, double margin)
    : Normal(
        Cross(triangle.Corner[1] - triangle.Corner[0], triangle.Corner[2] - triangle.Corner[0])),
      Origin(triangle.Corner[0]), Margin(margin)
  {
    for (int k = 0; k < 3; ++k)
    {
      double VectorD::*axis = Axes[k];
      const VectorD* p = triangle.Corner;
      this->Low[k] = std::min({ p[0].*axis, p[1].*axis, p[2].*axis }) - margin;
      this->High[k] = std::max({ p[0].*axis, p[1].*axis, p[2].*axis }) + margin;
    }
  }

  bool Overlaps(const TriangleTree::Node& node) const
  {
    double middle = 0.;
    double half = this->Margin * Length(this->Normal);
    for (int k = 0; k < 3; ++k)
    {
      if (node.Box.Low[k] > this->High[k] || node.Box.High[k] < this->Low[k])
      {
        return false;
      }
      const double n = this->Normal.*Axes[k];
      middle += n * (0.5 * (node.Box.Low[k] + node.Box.High[k]) - this->Origin.*Axes[k]);
      half += std::abs(n) * (0.5 * (node.Box.High[k] - node.Box.Low[k]) + this->Margin);
    }
    return std::abs(middle) <= half;
  }

private:
  static constexpr double VectorD::*Axes[3] = { &VectorD::X, &VectorD::Y, &VectorD::Z };
  VectorD Normal;
  VectorD Origin;
  double Margin;
  Point Low;
  Point High;
};

double LargestCoordinate(const IndexedSurface& surface)
{
  double largest = 0.;
  for (const Triangle& t : surface.Triangles)
  {
    for (const int corner : t)
    {
      const Point& p = surface.Points[corner];
      largest = std::max({ largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2]) });
    }
  }
  return largest;
}
}

int CountSelfIntersections(const IndexedSurface& surface, int limit, IntersectionCounters* counters)
{
  const int count = static_cast<int>(surface.Triangles.size());
  double sum = 0.;
  for (int i = 0; i < count; ++i)
  {
    const MeshTriangle triangle = RoundedTriangle(surface, i);
    sum += Length(triangle.Corner[1] - triangle.Corner[0]);
  }
  const double extent = LargestCoordinate(surface);
  const double meanEdge = sum / std::max(count, 1);
  const double tolerance = std::max(ToleranceOfEdges * meanEdge, ToleranceOfExtent * extent);
  const double margin = tolerance + RoundingOfExtent * extent;
  const TriangleTree tree(surface);
  int found = 0;
  for (int i = 0; i < count && !(limit > 0 && found >= limit); ++i)
  {
    const MeshTriangle triangle = RoundedTriangle(surface, i);
    const CandidateBox box(triangle, margin);
    tree.Traverse(
      [&](const TriangleTree::Node& node)
      {
        if (counters)
        {
          ++counters->Boxes;
        }
        return node.LargestIndex > i && box.Overlaps(node);
      },
      [&](int j)
      {
        if (j > i)
        {
          found += TrianglesIntersect(triangle, RoundedTriangle(surface, j), tolerance);
          if (counters)
          {
            ++counters->Pairs;
          }
        }
        return limit == 0 || found < limit;
      });
  }
  return found;
}
}

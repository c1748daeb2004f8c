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
NamedTriangle RoundedTriangle(const IndexedSurface& surface, int i)
{
  NamedTriangle triangle;
  for (int k = 0; k < 3; ++k)
  {
    const int corner = surface.Triangles[i][k];
    const Point& p = surface.Points[corner];
    triangle.Name[k] = corner;
    triangle.Corner[k] =
      VectorD(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  return triangle;
}

/** What of a tree may meet a triangle: boxes that its own meets, and that its plane passes. */
class MeetingBox
{
public:
  MeetingBox(const NamedTriangle& triangle, double room)
    : Normal(
        Cross(triangle.Corner[1] - triangle.Corner[0], triangle.Corner[2] - triangle.Corner[0])),
      Origin(triangle.Corner[0]), Room(room)
  {
    for (int k = 0; k < 3; ++k)
    {
      double VectorD::*axis = Axes[k];
      const VectorD* p = triangle.Corner;
      this->Low[k] = std::min({ p[0].*axis, p[1].*axis, p[2].*axis }) - room;
      this->High[k] = std::max({ p[0].*axis, p[1].*axis, p[2].*axis }) + room;
    }
  }

  bool Reaches(const TriangleTree::Node& node) const
  {
    double middle = 0.;
    double half = this->Room * Length(this->Normal);
    for (int k = 0; k < 3; ++k)
    {
      if (node.Box.Low[k] > this->High[k] || node.Box.High[k] < this->Low[k])
      {
        return false;
      }
      const double n = this->Normal.*Axes[k];
      middle += n * (0.5 * (node.Box.Low[k] + node.Box.High[k]) - this->Origin.*Axes[k]);
      half += std::abs(n) * (0.5 * (node.Box.High[k] - node.Box.Low[k]) + this->Room);
    }
    return std::abs(middle) <= half;
  }

private:
  static constexpr double VectorD::*Axes[3] = { &VectorD::X, &VectorD::Y, &VectorD::Z };
  VectorD Normal;
  VectorD Origin;
  double Room;
  Point Low;
  Point High;
};
}

int CountSelfIntersections(const IndexedSurface& surface, int limit, IntersectionWork* work)
{
  const int count = static_cast<int>(surface.Triangles.size());
  double sum = 0.;
  double extent = 0.;
  for (int i = 0; i < count; ++i)
  {
    const NamedTriangle triangle = RoundedTriangle(surface, i);
    sum += Length(triangle.Corner[1] - triangle.Corner[0]);
    for (const VectorD& p : triangle.Corner)
    {
      extent = std::max({ extent, std::abs(p.X), std::abs(p.Y), std::abs(p.Z) });
    }
  }
  const double tolerance = 1e-9 * std::max(2. * sum / std::max(count, 1), extent * 1e-5);
  // The tree has the points as they are, the tests have them rounded.
  const double room = tolerance + 1e-6 * extent;
  const TriangleTree tree(surface);
  int found = 0;
  for (int i = 0; i < count && !(limit > 0 && found >= limit); ++i)
  {
    const NamedTriangle triangle = RoundedTriangle(surface, i);
    const MeetingBox box(triangle, room);
    tree.Traverse(
      [&](const TriangleTree::Node& node)
      {
        if (work)
        {
          ++work->Boxes;
        }
        return node.Largest > i && box.Reaches(node);
      },
      [&](int j)
      {
        if (j > i)
        {
          found += TrianglesIntersect(triangle, RoundedTriangle(surface, j), tolerance);
          if (work)
          {
            ++work->Pairs;
          }
        }
        return limit == 0 || found < limit;
      });
  }
  return found;
}
}

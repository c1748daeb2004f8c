// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Mesh/TriangleTree.h"

#include "Core/Common/Vector.h"
#include "Core/Mesh/TriangleDistance.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** Maximum number of triangles in a leaf. Affects the run time only. */
constexpr int LeafSize = 4;

double SquaredDistanceToBox(const Point& point, const Bounds& box)
{
  double sum = 0.;
  for (int k = 0; k < 3; ++k)
  {
    const double beyond = std::max({ box.Low[k] - point[k], point[k] - box.High[k], 0. });
    sum += beyond * beyond;
  }
  return sum;
}
}

TriangleTree::TriangleTree(const IndexedSurface& surface)
  : Surface(surface), Order(surface.Triangles.size())
{
  std::iota(this->Order.begin(), this->Order.end(), 0);
  LargeVector<Point> centres;
  centres.reserve(surface.Triangles.size());
  for (const Triangle& t : surface.Triangles)
  {
    Point centre;
    for (int k = 0; k < 3; ++k)
    {
      centre[k] = surface.Points[t[0]][k] + surface.Points[t[1]][k] + surface.Points[t[2]][k];
    }
    centres.push_back(centre);
  }
  if (!centres.empty())
  {
    this->Nodes.reserve(centres.size());
    this->Build(0, static_cast<int>(centres.size()), centres);
  }
}

int TriangleTree::Build(int begin, int end, const LargeVector<Point>& centres)
{
  const int at = static_cast<int>(this->Nodes.size());
  Node node{ Bounds(), begin, end, -1, 0 };
  Bounds middles;
  for (int i = begin; i < end; ++i)
  {
    const int triangle = this->Order[i];
    node.LargestIndex = std::max(node.LargestIndex, triangle);
    middles.Add(centres[triangle]);
    for (int corner : this->Surface.Triangles[triangle])
    {
      node.Box.Add(this->Surface.Points[corner]);
    }
  }
  this->Nodes.push_back(node);
  if (end - begin <= LeafSize)
  {
    return at;
  }
  int axis = 0;
  const auto extent = [&middles](int k) { return middles.High[k] - middles.Low[k]; };
  for (int k = 1; k < 3; ++k)
  {
    axis = extent(k) > extent(axis) ? k : axis;
  }
  const int middle = begin + (end - begin) / 2;
  const auto first = this->Order.begin();
  std::nth_element(first + begin, first + middle, first + end,
    [&](int a, int b)
    { return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b; });
  this->Build(begin, middle, centres);
  const int second = this->Build(middle, end, centres);
  this->Nodes[at].SecondChild = second;
  return at;
}

double TriangleTree::SquaredDistance(const Point& point) const
{
  const VectorD p(point[0], point[1], point[2]);
  double nearest = std::numeric_limits<double>::max();
  struct Branch
  {
    int Node;
    double Squared;
  };
  Branch stack[MaximumDepth];
  int height = 0;
  stack[height++] = { 0, 0. };
  while (height > 0)
  {
    const Branch branch = stack[--height];
    if (branch.Squared >= nearest)
    {
      continue;
    }
    const Node& node = this->Nodes[branch.Node];
    if (node.SecondChild >= 0)
    {
      Branch closer{ branch.Node + 1,
        SquaredDistanceToBox(point, this->Nodes[branch.Node + 1].Box) };
      Branch further{ node.SecondChild,
        SquaredDistanceToBox(point, this->Nodes[node.SecondChild].Box) };
      if (closer.Squared > further.Squared)
      {
        std::swap(closer, further);
      }
      stack[height++] = further;
      stack[height++] = closer;
      continue;
    }
    for (int i = node.Begin; i < node.End; ++i)
    {
      VectorD t[3];
      for (int k = 0; k < 3; ++k)
      {
        const Point& q = this->Surface.Points[this->Surface.Triangles[this->Order[i]][k]];
        t[k] = VectorD(q[0], q[1], q[2]);
      }
      nearest = std::min(nearest, SquaredDistanceToTriangle(p, t));
    }
  }
  return nearest;
}
}

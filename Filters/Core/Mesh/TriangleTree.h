// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicTriangleTree_h
#define volumicTriangleTree_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Mesh/RowCrossing.h"

#include <vector>

namespace volumic
{
/**
 * Binary tree of bounding boxes of the triangles of a surface, for triangles of very different
 * sizes. Deterministic. The surface must outlive the tree. Lengths are in the unit of its points.
 */
class TriangleTree
{
public:
  struct Node
  {
    Bounds Box;
    int Begin; ///< Range of its triangles in Order.
    int End;
    int SecondChild;  ///< Node index; the first child follows its parent. -1: leaf.
    int LargestIndex; ///< Largest index of its triangles.
  };

  explicit TriangleTree(const IndexedSurface& surface);

  /**
   * Call visit(triangle) for the triangles of all leaves whose ancestors, and themselves, satisfy
   * enter(node). Stop if visit returns false.
   */
  template <typename Enter, typename Visit>
  void Traverse(Enter&& enter, Visit&& visit) const
  {
    int stack[MaximumDepth];
    int height = 0;
    if (!this->Nodes.empty())
    {
      stack[height++] = 0;
    }
    while (height > 0)
    {
      const int at = stack[--height];
      const Node& node = this->Nodes[at];
      if (!enter(node))
      {
        continue;
      }
      if (node.SecondChild >= 0)
      {
        stack[height++] = node.SecondChild;
        stack[height++] = at + 1;
        continue;
      }
      for (int i = node.Begin; i < node.End; ++i)
      {
        if (!visit(this->Order[i]))
        {
          return;
        }
      }
    }
  }

  /** Return the winding number of the triangles with counts(triangle) about a point. */
  template <typename Counts>
  int WindingNumber(const Point& point, const Counts& counts) const
  {
    int winding = 0;
    this->Traverse(
      [&point](const Node& node)
      {
        return node.Box.Low[0] <= point[0] && node.Box.Low[1] <= point[1] &&
          point[1] <= node.Box.High[1] && node.Box.Low[2] <= point[2] &&
          point[2] <= node.Box.High[2];
      },
      [&](int i)
      {
        const Triangle& t = this->Surface.Triangles[i];
        const auto corner = [&](int k) -> const Point& { return this->Surface.Points[t[k]]; };
        const RowCrossing crossing =
          RowCrossing::Of(corner(0), corner(1), corner(2), point[1], point[2]);
        winding += crossing.X < point[0] && counts(i) ? crossing.Winding : 0;
        return true;
      });
    return winding;
  }

  /** Return the squared distance to the nearest triangle. */
  double SquaredDistance(const Point& point) const;

private:
  /** The tree is balanced, so this suffices for any number of triangles in an int. */
  static constexpr int MaximumDepth = 64;

  int Build(int begin, int end, const LargeVector<Point>& centres);

  const IndexedSurface& Surface;
  LargeVector<int> Order; ///< Triangles; those of a node are contiguous.
  LargeVector<Node> Nodes;
};
}

#endif

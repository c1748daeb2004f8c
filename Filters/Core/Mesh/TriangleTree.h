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
 * The triangles of a surface in a binary tree of boxes. Unlike a grid it suits triangles of any
 * mixture of sizes: it has fewer nodes than there are triangles, however large these are. It is
 * made the same way in every run. The surface must outlive it; lengths are those of its points.
 */
class TriangleTree
{
public:
  struct Node
  {
    Bounds Box; ///< Of its triangles.
    int Begin;  ///< Of its triangles in the order of the tree.
    int End;
    int SecondChild;  ///< Index of the node; the first child follows its parent. -1: a leaf.
    int LargestIndex; ///< Of its triangles.
  };

  explicit TriangleTree(const IndexedSurface& surface);

  /**
   * Calls visit(triangle) for the triangles of all leaves that are reached: below nodes for which
   * enter(node) says so. Stops where visit returns false.
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

  /** How often those triangles wind round a place for which counts(triangle) says so. */
  template <typename Counts>
  int WindingAbout(const Point& place, const Counts& counts) const
  {
    int winding = 0;
    this->Traverse(
      [&place](const Node& node)
      {
        return node.Box.Low[0] <= place[0] && node.Box.Low[1] <= place[1] &&
          place[1] <= node.Box.High[1] && node.Box.Low[2] <= place[2] &&
          place[2] <= node.Box.High[2];
      },
      [&](int i)
      {
        const Triangle& t = this->Surface.Triangles[i];
        const auto corner = [&](int k) -> const Point& { return this->Surface.Points[t[k]]; };
        const RowCrossing crossing =
          RowCrossing::Of(corner(0), corner(1), corner(2), place[1], place[2]);
        winding += crossing.X < place[0] && counts(i) ? crossing.Winding : 0;
        return true;
      });
    return winding;
  }

  /** Distance to the nearest of the triangles, squared. */
  double SquaredDistance(const Point& place) const;

private:
  /** The tree is balanced: this serves any number of triangles that an int counts. */
  static constexpr int MaximumDepth = 64;

  int Build(int begin, int end, const LargeVector<Point>& centres);

  const IndexedSurface& Surface;
  LargeVector<int> Order; ///< The triangles, those of a node side by side.
  LargeVector<Node> Nodes;
};
}

#endif

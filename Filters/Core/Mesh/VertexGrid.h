// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexGrid_h
#define volumicVertexGrid_h

#include "Core/Common/Vector.h"

#include <vector>

namespace volumic
{
/**
 * Dense grid of cells with a chain of vertices in each: the one proximity structure that
 * contacts, merges and verification share. Finding all pairs within a radius is O(n).
 *
 * It is kept up to date vertex by vertex, at the cost of a comparison for one that stays in its
 * cell, so work follows the active part of the surface instead of its whole. Vertices numbered
 * along a space-filling curve make the chains run through memory nearly in order.
 * Positions beyond the grid belong to the cells of its border. Lengths: workspace.
 */
class VertexGrid
{
public:
  /** Empties it and lays cells of side `cell` over the box. */
  void Reset(const Vector& low, const Vector& high, float cell);

  void Insert(int v, const Vector& position);
  void Remove(int v);
  /** To be called after the vertex has moved. */
  void Move(int v, const Vector& position)
  {
    const int cell = this->CellOf(position);
    if (cell != this->Cell[v])
    {
      this->Remove(v);
      this->Link(v, cell);
    }
  }

  /** Calls visit(w) for a superset of the vertices within `radius` of a point. */
  template <typename Visitor>
  void Visit(const Vector& position, float radius, Visitor&& visit) const
  {
    const Vector margin(radius, radius, radius);
    this->VisitBox(position - margin, position + margin, visit);
  }

  /** Whether a vertex lies within `radius` of a point; `positions`: of all vertices. */
  bool HasWithin(const Vector& position, float radius, const std::vector<Vector>& positions) const
  {
    bool found = false;
    this->Visit(position, radius,
      [&](int w) { found = found || SquaredDistance(position, positions[w]) <= radius * radius; });
    return found;
  }

  /** Calls visit(w) for a superset of the vertices in a box. */
  template <typename Visitor>
  void VisitBox(const Vector& low, const Vector& high, Visitor&& visit) const
  {
    const int x0 = this->Along(low.X, 0);
    const int x1 = this->Along(high.X, 0);
    const int y0 = this->Along(low.Y, 1);
    const int y1 = this->Along(high.Y, 1);
    const int z0 = this->Along(low.Z, 2);
    const int z1 = this->Along(high.Z, 2);
    for (int z = z0; z <= z1; ++z)
    {
      for (int y = y0; y <= y1; ++y)
      {
        const int row = (z * this->Size[1] + y) * this->Size[0];
        for (int x = x0; x <= x1; ++x)
        {
          for (int w = this->Head[row + x]; w >= 0; w = this->Next[w])
          {
            visit(w);
          }
        }
      }
    }
  }

private:
  int Along(float x, int axis) const
  {
    const float place = (x - this->Low[axis]) * this->Inverse;
    const int last = this->Size[axis] - 1;
    return place <= 0 ? 0 : (place >= static_cast<float>(last) ? last : static_cast<int>(place));
  }
  int CellOf(const Vector& p) const
  {
    return (this->Along(p.Z, 2) * this->Size[1] + this->Along(p.Y, 1)) * this->Size[0] +
      this->Along(p.X, 0);
  }
  void Link(int v, int cell)
  {
    this->Cell[v] = cell;
    this->Next[v] = this->Head[cell];
    this->Head[cell] = v;
  }

  std::vector<int> Head;
  std::vector<int> Next;
  std::vector<int> Cell;
  int Size[3] = { 1, 1, 1 };
  float Low[3] = { 0, 0, 0 };
  float Inverse = 1;
};
}

#endif

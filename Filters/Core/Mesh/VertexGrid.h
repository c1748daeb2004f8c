// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVertexGrid_h
#define volumicVertexGrid_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Common/Vector.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace volumic
{
/**
 * Grid of cells with a chain of vertices in each: the one proximity structure that contacts, merges
 * and verification share. Finding all pairs within a radius is O(n). Chains are in order of index,
 * so that what is visited in which order does not depend on how the vertices have come there.
 *
 * Cells are kept in bricks of 8 x 8 x 8, which there are only where vertices have been: memory goes
 * with the surface, not with the box.
 *
 * It is kept up to date vertex by vertex, at the cost of a comparison for one that stays in its
 * cell, so work follows the active part of the surface instead of its whole. Vertices numbered
 * along a space-filling curve make the chains run through memory nearly in order.
 * Positions beyond the grid belong to the cells of its border. Lengths: workspace.
 *
 * Threads may insert, remove and move vertices at the same time if no two of them touch, or visit,
 * what another one changes: the same cell of the grid. There must be room for the vertices then.
 */
class VertexGrid
{
public:
  /** Empties it and lays cells of side `cell` over the box. */
  void Reset(const Vector& low, const Vector& high, float cell);

  /** Makes room for vertices of indices below n. */
  void Resize(std::size_t n);

  /** Takes all vertices out. */
  void Clear();

  void Insert(int v, const Vector& position);
  /**
   * All vertices from `first` on for which isThere(v), as if one by one, in order of index. None of
   * these may be in it before.
   */
  void InsertAll(const LargeVector<Vector>& positions, std::size_t first,
    const std::function<bool(int v)>& isThere, Executor& executor);
  void Remove(int v);
  /** To be called after the vertex has moved. */
  void Move(int v, const Vector& position)
  {
    const std::uint32_t cell = this->CellOf(position);
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
  bool HasWithin(const Vector& position, float radius, const LargeVector<Vector>& positions) const
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
    this->VisitGroups(low, high,
      [&](const int* group, int count)
      {
        for (int i = 0; i < count; ++i)
        {
          visit(group[i]);
        }
      });
  }

  /**
   * Call visit(group, count) for groups of the same vertices in the same order. A group has at most
   * LargestGroup vertices, and its array always has room for that many.
   */
  template <typename Visitor>
  void VisitGroups(const Vector& low, const Vector& high, Visitor&& visit) const
  {
    const int x0 = this->Along(low.X, 0);
    const int x1 = this->Along(high.X, 0);
    const int y0 = this->Along(low.Y, 1);
    const int y1 = this->Along(high.Y, 1);
    const int z0 = this->Along(low.Z, 2);
    const int z1 = this->Along(high.Z, 2);
    FirstVertices firsts;
    for (int z = z0; z <= z1; ++z)
    {
      for (int y = y0; y <= y1; ++y)
      {
        this->AddRow(x0, x1, y, z, firsts, visit);
      }
    }
    this->VisitChains(firsts, visit);
  }
  static constexpr int LargestGroup = 64;

  /** Bricks that there are, for tests of what it costs. */
  std::size_t NumberOfBricks() const { return this->NumberMade; }

private:
  static constexpr int Bits = 3; ///< Of a coordinate within a brick.
  static constexpr int Mask = (1 << Bits) - 1;
  using Brick =
    std::array<int, std::size_t(1) << (3 * Bits)>; ///< First vertex of each cell, or -1.
  static constexpr std::uint32_t NoCell = 0xffffffff;

  static std::size_t IndexInBrick(int x, int y, int z)
  {
    return static_cast<std::size_t>((((z & Mask) << Bits) + (y & Mask)) << Bits) + (x & Mask);
  }
  std::size_t NumberOfBrick(int x, int y, int z) const
  {
    return (static_cast<std::size_t>(z >> Bits) * this->BricksAlong[1] + (y >> Bits)) *
      this->BricksAlong[0] +
      (x >> Bits);
  }
  /** Of cells that are not empty: collected first, as their vertices are fetched faster then. */
  struct FirstVertices
  {
    int Item[LargestGroup];
    int Count = 0;
  };
  /** All chains side by side, a vertex of each in turn: none waits for the one before it. */
  template <typename Visitor>
  void VisitChains(FirstVertices& firsts, Visitor&& visit) const
  {
    while (firsts.Count > 0)
    {
      visit(static_cast<const int*>(firsts.Item), firsts.Count);
      int count = 0; // No branches: of what has ended the place is written over.
      for (int i = 0; i < firsts.Count; ++i)
      {
        const int next = this->Next[firsts.Item[i]];
        firsts.Item[count] = next;
        count += next >= 0 ? 1 : 0;
      }
      firsts.Count = count;
    }
  }
  /** The cells x0 to x1 of a row; those collected are visited where there is no room for more. */
  template <typename Visitor>
  void AddRow(int x0, int x1, int y, int z, FirstVertices& firsts, Visitor&& visit) const
  {
    const auto* bricks = this->Bricks.data() + this->NumberOfBrick(0, y, z);
    const std::size_t row = IndexInBrick(0, y, z);
    for (int x = x0; x <= x1;)
    {
      // The part of the row that lies in one brick.
      const int count = std::min(x1, x | Mask) + 1 - x;
      const Brick* brick = bricks[x >> Bits].load(std::memory_order_acquire);
      if (brick)
      {
        if (firsts.Count + Mask + 1 > LargestGroup)
        {
          this->VisitChains(firsts, visit);
        }
        const int* heads = brick->data() + row + (x & Mask);
        int found = firsts.Count; // No branches: what is empty is written over.
        for (int i = 0; i < count; ++i)
        {
          firsts.Item[found] = heads[i];
          found += heads[i] >= 0 ? 1 : 0;
        }
        firsts.Count = found;
      }
      x += count;
    }
  }

  int Along(float x, int axis) const
  {
    const float place = (x - this->Low[axis]) * this->Inverse;
    const int last = this->Size[axis] - 1;
    return place <= 0 ? 0 : (place >= static_cast<float>(last) ? last : static_cast<int>(place));
  }
  std::uint32_t CellOf(const Vector& p) const
  {
    const std::size_t row =
      static_cast<std::size_t>(this->Along(p.Z, 2)) * this->Size[1] + this->Along(p.Y, 1);
    return static_cast<std::uint32_t>(row * this->Size[0] + this->Along(p.X, 0));
  }
  /** The layer of bricks that a cell lies in. */
  std::size_t LayerOf(std::uint32_t cell) const
  {
    return static_cast<std::size_t>(cell /
             (static_cast<std::uint32_t>(this->Size[0]) *
               static_cast<std::uint32_t>(this->Size[1]))) >>
      Bits;
  }
  /** The first vertex of a cell, in a brick that is made where there is none. */
  int& HeadOf(std::uint32_t cell);
  Brick* MakeBrick(std::size_t number);
  void Link(int v, std::uint32_t cell);

  LargeVector<std::atomic<Brick*>> Bricks; ///< Null where no vertex has been.
  std::vector<LargeVector<Brick>> Made;    ///< Each with room for as many as all before.
  std::size_t NumberMade = 0;              ///< Bricks in use.
  std::mutex Making;                       ///< Held while a brick is made.
  LargeVector<int> Next;
  LargeVector<std::uint32_t> Cell;
  int Size[3] = { 1, 1, 1 };
  int BricksAlong[2] = { 1, 1 };
  float Low[3] = { 0, 0, 0 };
  float Inverse = 1;
};
}

#endif

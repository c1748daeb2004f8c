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
 * Uniform grid of cells with a linked list of vertices in each, for all proximity queries. All
 * pairs within a radius are found in O(n). Lists are sorted by index, so the order of visits does
 * not depend on the order of insertion.
 *
 * Cells are stored in bricks of 8 x 8 x 8, allocated on first use: memory is proportional to the
 * surface, not to the box. An update costs one comparison for a vertex that stays in its cell.
 * Vertices numbered along a space-filling curve make list traversal nearly sequential in memory.
 * Positions outside the box belong to the cells at its border. Lengths are in the computational
 * space.
 *
 * Threads may insert, remove and move vertices concurrently if no thread changes a cell that
 * another one changes or visits. Resize() must have been called before.
 */
class VertexGrid
{
public:
  /** Remove all vertices and cover the box with cells of side `cell`. */
  void Reset(const Vector& low, const Vector& high, float cell);

  /** Allocate slots for vertices with indices below n. */
  void Resize(std::size_t n);

  void Clear();

  void Insert(int v, const Vector& position);
  /**
   * Insert all vertices from `first` on for which isThere(v) is true. The result is the same as if
   * they were inserted one by one. None of them may be in the grid before.
   */
  void InsertAll(const LargeVector<Vector>& positions, std::size_t first,
    const std::function<bool(int v)>& isThere, Executor& executor);
  void Remove(int v);
  /** Update the cell of a vertex after it has moved. */
  void Move(int v, const Vector& position)
  {
    const std::uint32_t cell = this->CellOf(position);
    if (cell != this->Cell[v])
    {
      this->Remove(v);
      this->Link(v, cell);
    }
  }
  /** Call visit(w) for a superset of the vertices within `radius` of a point. */
  template <typename Visitor>
  void Visit(const Vector& position, float radius, Visitor&& visit) const
  {
    const Vector margin(radius, radius, radius);
    this->VisitBox(position - margin, position + margin, visit);
  }

  /** Return whether a vertex, of these positions, lies within `radius` of a point. */
  bool HasWithin(const Vector& position, float radius, const LargeVector<Vector>& positions) const
  {
    bool found = false;
    this->Visit(position, radius,
      [&](int w) { found = found || SquaredDistance(position, positions[w]) <= radius * radius; });
    return found;
  }

  /** Call visit(w) for a superset of the vertices in a box. */
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
   * Call visit(group, count) for groups of these vertices, in the order of VisitBox(). A group has
   * at most LargestGroup vertices, and its array always has room for that many.
   */
  template <typename Visitor>
  void VisitGroups(const Vector& low, const Vector& high, Visitor&& visit) const
  {
    const int x0 = this->CellAlong(low.X, 0);
    const int x1 = this->CellAlong(high.X, 0);
    const int y0 = this->CellAlong(low.Y, 1);
    const int y1 = this->CellAlong(high.Y, 1);
    const int z0 = this->CellAlong(low.Z, 2);
    const int z1 = this->CellAlong(high.Z, 2);
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

private:
  static constexpr int Bits = 3; ///< Bits of a coordinate within a brick.
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
  /** First vertices of nonempty cells. Collecting them first speeds up the fetch of their lists. */
  struct FirstVertices
  {
    int Item[LargestGroup];
    int Count = 0;
  };
  /** Visit all lists in parallel, one vertex of each in turn, to hide the latency of memory. */
  template <typename Visitor>
  void VisitChains(FirstVertices& firsts, Visitor&& visit) const
  {
    while (firsts.Count > 0)
    {
      visit(static_cast<const int*>(firsts.Item), firsts.Count);
      int count = 0; // Branchless: the slot of a list that has ended is overwritten.
      for (int i = 0; i < firsts.Count; ++i)
      {
        const int next = this->Next[firsts.Item[i]];
        firsts.Item[count] = next;
        count += next >= 0 ? 1 : 0;
      }
      firsts.Count = count;
    }
  }
  /** Add the cells x0 to x1 of a row. If there is no space, visit the collected ones first. */
  template <typename Visitor>
  void AddRow(int x0, int x1, int y, int z, FirstVertices& firsts, Visitor&& visit) const
  {
    const auto* bricks = this->Bricks.data() + this->NumberOfBrick(0, y, z);
    const std::size_t row = IndexInBrick(0, y, z);
    for (int x = x0; x <= x1;)
    {
      const int count = std::min(x1, x | Mask) + 1 - x;
      const Brick* brick = bricks[x >> Bits].load(std::memory_order_acquire);
      if (brick)
      {
        if (firsts.Count + Mask + 1 > LargestGroup)
        {
          this->VisitChains(firsts, visit);
        }
        const int* heads = brick->data() + row + (x & Mask);
        int found = firsts.Count; // Branchless: empty cells are overwritten.
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

  int CellAlong(float x, int axis) const
  {
    const float cell = (x - this->Low[axis]) * this->Inverse;
    const int last = this->Size[axis] - 1;
    return cell <= 0 ? 0 : (cell >= static_cast<float>(last) ? last : static_cast<int>(cell));
  }
  std::uint32_t CellOf(const Vector& p) const
  {
    const std::size_t row =
      static_cast<std::size_t>(this->CellAlong(p.Z, 2)) * this->Size[1] + this->CellAlong(p.Y, 1);
    return static_cast<std::uint32_t>(row * this->Size[0] + this->CellAlong(p.X, 0));
  }
  /** Return the layer of bricks that contains a cell. */
  std::size_t LayerOf(std::uint32_t cell) const
  {
    return static_cast<std::size_t>(cell /
             (static_cast<std::uint32_t>(this->Size[0]) *
               static_cast<std::uint32_t>(this->Size[1]))) >>
      Bits;
  }
  /** Return the first vertex of a cell. Allocate its brick if there is none. */
  int& HeadOf(std::uint32_t cell);
  Brick* MakeBrick(std::size_t number);
  void Link(int v, std::uint32_t cell);

  LargeVector<std::atomic<Brick*>> Bricks; ///< Null where no vertex has been.
  std::vector<LargeVector<Brick>> Made;    ///< Capacity doubles, up to a limit.
  std::size_t NumberMade = 0;
  std::mutex Making; ///< Guards the allocation of bricks.
  LargeVector<int> Next;
  LargeVector<std::uint32_t> Cell;
  int Size[3] = { 1, 1, 1 };
  int BricksAlong[2] = { 1, 1 };
  float Low[3] = { 0, 0, 0 };
  float Inverse = 1;
};
}

#endif

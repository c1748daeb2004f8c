// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDisjointSets_h
#define volumicDisjointSets_h

#include "Core/Common/Grow.h"
#include "Core/Common/ScratchMemory.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <numeric>

namespace volumic
{
/**
 * Union-find over the integers from 0 on. The root of a set is its smallest member.
 *
 * Several threads may work on one object side by side, each on a range of its own that it alone
 * makes, finds and joins; what joins two ranges comes afterwards. FindRoot changes nothing.
 */
class DisjointSets
{
public:
  /** n sets of one integer each. */
  explicit DisjointSets(std::size_t n = 0) : Parent(n)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }

  /** For integers below n; each is in no set, and takes no memory, before MakeSet. */
  void MakeRoom(std::size_t n)
  {
    if (this->Parent.size() < n)
    {
      MakeZeroed(this->Parent, WithRoomToGrow(n));
    }
  }

  /** A set of its own for i, whatever it was in before. */
  void MakeSet(int i) { this->Parent[i] = i; }

  /** The root of the set that i is in. Makes the ways of later calls shorter. */
  int Find(int i)
  {
    while (this->Parent[i] != i)
    {
      this->Parent[i] = this->Parent[this->Parent[i]];
      i = this->Parent[i];
    }
    return i;
  }

  /** The same without changing anything, so that threads may look at once. */
  int FindRoot(int i) const
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i];
    }
    return i;
  }

  /** @return the root of the set that both are in from now on. */
  int Join(int i, int j)
  {
    i = this->Find(i);
    j = this->Find(j);
    const int root = std::min(i, j);
    this->Parent[std::max(i, j)] = root;
    return root;
  }

private:
  LargeVector<int> Parent; ///< A smaller member of the set, or, of the root, itself.
};

/**
 * The same for threads that join any integers at once, without locks (R. J. Anderson and H. Woll,
 * "Wait-free Parallel Algorithms for the Union-Find Problem", STOC 1991): the sets, and so their
 * roots, are those of any order of the joins.
 */
class SharedDisjointSets
{
public:
  /** n sets of one integer each. */
  explicit SharedDisjointSets(std::size_t n) : Parent(n)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      this->Parent[i].store(static_cast<int>(i), std::memory_order_relaxed);
    }
  }

  /** The root of the set that i is in at the moment, as other threads may join sets. */
  int Find(int i)
  {
    for (;;)
    {
      int parent = this->Parent[i].load(std::memory_order_relaxed);
      const int next = this->Parent[parent].load(std::memory_order_relaxed);
      if (parent == next)
      {
        return parent;
      }
      // Shortens the way, unless somebody has done so; either leads to the root.
      this->Parent[i].compare_exchange_weak(parent, next, std::memory_order_relaxed);
      i = next;
    }
  }

  void Join(int i, int j)
  {
    for (;;)
    {
      i = this->Find(i);
      j = this->Find(j);
      int larger = std::max(i, j);
      // The larger root gets a parent, if it still is one.
      if (i == j ||
        this->Parent[larger].compare_exchange_strong(
          larger, std::min(i, j), std::memory_order_relaxed))
      {
        return;
      }
    }
  }

private:
  LargeVector<std::atomic<int>> Parent; ///< A smaller member of the set, or, of the root, itself.
};
}

#endif

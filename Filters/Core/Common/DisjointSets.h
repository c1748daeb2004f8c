// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDisjointSets_h
#define volumicDisjointSets_h

#include "Core/Common/ScratchMemory.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace volumic
{
/**
 * Union-find over the integers from 0 on. The root of a set is its smallest member.
 *
 * Threads may join any integers at once, without locks (R. J. Anderson and H. Woll, "Wait-free
 * Parallel Algorithms for the Union-Find Problem", STOC 1991): the sets are those of any order.
 */
class DisjointSets
{
public:
  /** n sets of one integer each. */
  explicit DisjointSets(std::size_t n) : Parent(n)
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

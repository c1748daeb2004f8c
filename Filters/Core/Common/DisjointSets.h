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
 * Thread-safe and lock-free (R. J. Anderson and H. Woll, "Wait-free Parallel Algorithms for the
 * Union-Find Problem", STOC 1991). The sets do not depend on the order of the calls.
 */
class DisjointSets
{
public:
  /** Create n sets of one integer each. */
  explicit DisjointSets(std::size_t n) : Parent(n)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      this->Parent[i].store(static_cast<int>(i), std::memory_order_relaxed);
    }
  }

  /** Return the current root of the set of i. Other threads may join sets meanwhile. */
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
      // Path halving. If another thread has changed the entry, it still leads to the root.
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
      // Fails if the larger one is not a root any more.
      if (i == j ||
        this->Parent[larger].compare_exchange_strong(
          larger, std::min(i, j), std::memory_order_relaxed))
      {
        return;
      }
    }
  }

private:
  LargeVector<std::atomic<int>> Parent; ///< smaller member of the set; of a root: itself
};
}

#endif

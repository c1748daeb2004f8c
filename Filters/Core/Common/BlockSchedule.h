// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicBlockSchedule_h
#define volumicBlockSchedule_h

#include "Core/Common/Executor.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/**
 * Items that are visited once each, where some touch: those that do are visited one after the
 * other, in a fixed order, all others at the same time. What comes of it is what one thread alone
 * would make, visiting them in that order.
 *
 * Nothing waits for more than what it touches: a thread takes the first item, in the order, all of
 * whose earlier neighbours have been visited.
 */
class BlockSchedule
{
public:
  /**
   * @param order      all items, from 0, in the order of their visits
   * @param neighbours of an item: those that it touches, without itself; it touches them, too
   */
  BlockSchedule(
    std::vector<int> order, const std::function<std::vector<int>(int item)>& neighbours);

  /** The items in their order. */
  const std::vector<int>& Order() const { return this->Items; }
  /**
   * Call visit(item) for all items on the threads of an executor, and return when all calls have
   * ended. The first exception of a visit is rethrown after the visits under way have ended.
   * @param goOn called with the number of visits done, on the calling thread, after each visit that
   *             this thread makes; false skips the visits that have not begun
   * @return whether goOn has always returned true
   */
  bool Run(Executor& executor, const std::function<void(int item)>& visit,
    const std::function<bool(std::size_t done)>& goOn) const;

private:
  std::vector<int> Items;
  std::vector<int> Earlier; ///< By place in the order: how many of those it touches come before it.
  std::vector<std::vector<int>> Later; ///< By place: the places of those that come after it.
};
}

#endif

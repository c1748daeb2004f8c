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
 * Parallel schedule of items, some of which are neighbours. Neighbours are processed one after the
 * other in a fixed order, all other items in parallel. The result is that of one thread which
 * processes all items in that order.
 *
 * A thread takes the first item whose earlier neighbours have all been processed.
 */
class BlockSchedule
{
public:
  /**
   * @param order      all items, from 0, in the order of processing
   * @param neighbours returns the neighbours of an item, without itself; the relation is symmetric
   */
  BlockSchedule(
    std::vector<int> order, const std::function<std::vector<int>(int item)>& neighbours);

  /** Return the items in the order of processing. */
  const std::vector<int>& Order() const { return this->Items; }
  /**
   * Call process(item) for all items on the threads of an executor, and return when all calls have
   * ended. The first exception is rethrown after the calls in progress have ended.
   * @param goOn called on the calling thread, with the number of items done, after each item that
   *             this thread has processed; false skips the items that have not begun
   * @return false if goOn has returned false
   */
  bool Run(Executor& executor, const std::function<void(int item)>& process,
    const std::function<bool(std::size_t done)>& goOn) const;

private:
  std::vector<int> Items;
  std::vector<int> Earlier;            ///< number of earlier neighbours, by position in the order
  std::vector<std::vector<int>> Later; ///< positions of the later neighbours, by position
};
}

#endif

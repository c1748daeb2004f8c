// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVisitSchedule_h
#define volumicVisitSchedule_h

#include "Core/Common/Executor.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace volumic
{
/** Makes the visit of an item, at its place in the order of a schedule: see VisitSchedule::Run. */
using VisitBody = std::function<void(int item, std::size_t place, Executor& idle)>;

/**
 * Items that are visited once each, where some touch: those that do are visited one after the other,
 * in a fixed order, all others at the same time. What comes of it is what one thread alone would
 * make, visiting them in that order.
 *
 * Nothing waits for more than what it touches: a thread takes the first item, in the order, all of
 * whose earlier neighbours have been visited.
 */
class VisitSchedule
{
public:
  /**
   * @param order      all items, from 0, in the order of their visits
   * @param neighbours of an item: those that it touches, without itself; it touches them, too
   */
  VisitSchedule(
    std::vector<int> order, const std::function<std::vector<int>(int item)>& neighbours);

  /** The items in their order. */
  const std::vector<int>& Order() const { return this->Items; }
  /**
   * Calls visit(item, place in the order, idle) for all, on the threads of an executor, and returns
   * when all are done. By `idle` a visit shares out what it has to do with the threads that find no
   * visit to make at the time; where there are none it does all itself.
   * An exception of a visit ends it; others that are under way are finished first.
   * @param goOn asked with how many are done, by the calling thread: after each visit that it makes,
   *             or several times a second; false ends it
   * @return whether nothing asked to end it
   */
  bool Run(Executor& executor, const VisitBody& visit,
    const std::function<bool(std::size_t done)>& goOn) const;

private:
  class Progress;

  std::vector<int> Items;
  std::vector<int> Place;    ///< Of an item in the order.
  std::vector<int> Earlier;  ///< Of an item: how many of those it touches come before it.
  std::vector<std::vector<int>> Later; ///< Of an item: those that it touches and that come after.
};
}

#endif

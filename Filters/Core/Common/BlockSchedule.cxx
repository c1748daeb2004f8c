// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/BlockSchedule.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <mutex>
#include <queue>
#include <thread>
#include <utility>

namespace volumic
{
BlockSchedule::BlockSchedule(
  std::vector<int> order, const std::function<std::vector<int>(int item)>& neighbours)
  : Items(std::move(order)), Earlier(this->Items.size(), 0), Later(this->Items.size())
{
  std::vector<int> places(this->Items.size());
  for (std::size_t place = 0; place < this->Items.size(); ++place)
  {
    places[this->Items[place]] = static_cast<int>(place);
  }
  for (std::size_t place = 0; place < this->Items.size(); ++place)
  {
    for (const int other : neighbours(this->Items[place]))
    {
      if (places[other] > static_cast<int>(place))
      {
        this->Later[place].push_back(places[other]);
        ++this->Earlier[places[other]];
      }
    }
  }
}

bool BlockSchedule::Run(Executor& executor, const std::function<void(int item)>& visit,
  const std::function<bool(std::size_t done)>& goOn) const
{
  std::size_t done = 0;
  if (executor.NumberOfThreads() == 1)
  {
    return std::all_of(this->Items.begin(), this->Items.end(),
      [&](int item)
      {
        visit(item);
        return goOn(++done);
      });
  }
  const std::thread::id caller = std::this_thread::get_id();
  bool goesOn = true; // Changed by the calling thread only.
  std::mutex mutex;   // Of the number done and the next two.
  std::vector<int> waits = this->Earlier;
  std::priority_queue<int, std::vector<int>, std::greater<int>> ready; // Places in the order.
  executor.Execute(
    [&]
    {
      tbb::task_group group;
      // As many tasks as items are ready: each takes the first of these in the order.
      std::function<void()> visitNext;
      const auto add = [&](int place)
      {
        ready.push(place);
        group.run(visitNext);
      };
      visitNext = [&]
      {
        std::unique_lock<std::mutex> lock(mutex);
        const bool isCaller = std::this_thread::get_id() == caller;
        const auto place = static_cast<std::size_t>(ready.top());
        ready.pop();
        lock.unlock();
        visit(this->Items[place]);
        lock.lock();
        for (const int later : this->Later[place])
        {
          if (--waits[later] == 0)
          {
            add(later);
          }
        }
        const std::size_t now = ++done;
        lock.unlock();
        if (isCaller && goesOn && !goOn(now))
        {
          goesOn = false;
          group.cancel();
        }
      };
      std::unique_lock<std::mutex> lock(mutex);
      for (std::size_t place = 0; place < this->Items.size(); ++place)
      {
        if (this->Earlier[place] == 0)
        {
          add(static_cast<int>(place));
        }
      }
      lock.unlock();
      group.wait();
      lock.lock(); // Tells ThreadSanitizer that all have ended.
    });
  return goesOn;
}
}

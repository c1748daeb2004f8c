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
  std::vector<int> positions(this->Items.size());
  for (std::size_t position = 0; position < this->Items.size(); ++position)
  {
    positions[this->Items[position]] = static_cast<int>(position);
  }
  for (std::size_t position = 0; position < this->Items.size(); ++position)
  {
    for (const int other : neighbours(this->Items[position]))
    {
      if (positions[other] > static_cast<int>(position))
      {
        this->Later[position].push_back(positions[other]);
        ++this->Earlier[positions[other]];
      }
    }
  }
}

bool BlockSchedule::Run(Executor& executor, const std::function<void(int item)>& process,
  const std::function<bool(std::size_t done)>& goOn) const
{
  std::size_t done = 0;
  if (executor.NumberOfThreads() == 1)
  {
    return std::all_of(this->Items.begin(), this->Items.end(),
      [&](int item)
      {
        process(item);
        return goOn(++done);
      });
  }
  const std::thread::id caller = std::this_thread::get_id();
  bool goesOn = true; // Written by the calling thread only.
  std::mutex mutex;   // Guards done, waits and ready.
  std::vector<int> waits = this->Earlier;
  std::priority_queue<int, std::vector<int>, std::greater<int>> ready; // Positions.
  executor.Execute(
    [&]
    {
      tbb::task_group group;
      // One task per ready item. Each task takes the first ready item in the order.
      std::function<void()> processNext;
      const auto add = [&](int position)
      {
        ready.push(position);
        group.run(processNext);
      };
      processNext = [&]
      {
        std::unique_lock<std::mutex> lock(mutex);
        const bool isCaller = std::this_thread::get_id() == caller;
        const auto position = static_cast<std::size_t>(ready.top());
        ready.pop();
        lock.unlock();
        process(this->Items[position]);
        lock.lock();
        for (const int later : this->Later[position])
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
      for (std::size_t position = 0; position < this->Items.size(); ++position)
      {
        if (this->Earlier[position] == 0)
        {
          add(static_cast<int>(position));
        }
      }
      lock.unlock();
      group.wait();
      lock.lock(); // Shows ThreadSanitizer that all tasks have ended.
    });
  return goesOn;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMessageQueues_h
#define volumicMessageQueues_h

#include "TestPrelude.h"

#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>

namespace volumic
{
/** What ranks that are threads send each other: a queue for each two of them. */
class MessageQueues
{
public:
  explicit MessageQueues(int ranks)
    : Ranks(ranks)
    , Sent(static_cast<std::size_t>(ranks) * static_cast<std::size_t>(ranks))
  {
  }
  int NumberOfRanks() const { return this->Ranks; }

  void Send(int from, int to, const void* bytes, std::size_t count)
  {
    const char* begin = static_cast<const char*>(bytes);
    const std::lock_guard<std::mutex> lock(this->Lock);
    this->Queue(from, to).emplace_back(begin, begin + count);
    this->Arrived.notify_all();
  }

  /** @param from a negative one: whoever sends */
  void Receive(int from, int to, void* bytes, std::size_t count)
  {
    std::unique_lock<std::mutex> lock(this->Lock);
    std::deque<std::vector<char>>* queue = nullptr;
    this->Arrived.wait(lock,
      [&]
      {
        for (int other = 0; other < this->Ranks && !queue; ++other)
        {
          const bool isMeant = from < 0 || from == other;
          queue = isMeant && !this->Queue(other, to).empty() ? &this->Queue(other, to) : nullptr;
        }
        return queue != nullptr;
      });
    const std::vector<char> message = std::move(queue->front());
    queue->pop_front();
    if (message.size() != count)
    {
      throw std::logic_error("what is received is not what was sent");
    }
    std::memcpy(bytes, message.data(), count);
  }

private:
  std::deque<std::vector<char>>& Queue(int from, int to)
  {
    return this->Sent[static_cast<std::size_t>(from * this->Ranks + to)];
  }

  int Ranks;
  std::mutex Lock;
  std::condition_variable Arrived;
  std::vector<std::deque<std::vector<char>>> Sent;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThreadRanks_h
#define volumicThreadRanks_h

#include "Core/Common/Communicator.h"

#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace volumic
{
/** Threads of the test in the place of processes: what they send each other goes through queues. */
class ThreadRanks
{
public:
  /**
   * Calls work on each of so many threads, with a communicator of its own. What one of them throws
   * is told to the others, and thrown here at last: that of the lowest rank.
   */
  static void Run(int count, const std::function<void(Communicator& ranks)>& work)
  {
    const auto queues = std::make_shared<Queues>(count);
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank)
    {
      threads.emplace_back(
        [&, rank]
        {
          Ranks ranks(queues, rank);
          try
          {
            work(ranks);
          }
          catch (const std::exception& error)
          {
            errors[static_cast<std::size_t>(rank)] = std::current_exception();
            ranks.Fail(error.what());
          }
        });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    for (const std::exception_ptr& error : errors)
    {
      if (error)
      {
        std::rethrow_exception(error);
      }
    }
  }

private:
  struct Queues
  {
    explicit Queues(int count)
      : Count(count)
      , Sent(static_cast<std::size_t>(count) * static_cast<std::size_t>(count))
    {
    }
    std::deque<Message>& From(int from, int to)
    {
      return this->Sent[static_cast<std::size_t>(from * this->Count + to)];
    }
    int Count;
    std::mutex Lock;
    std::condition_variable Arrived;
    std::vector<std::deque<Message>> Sent;
  };

  class Ranks final : public Communicator
  {
  public:
    Ranks(std::shared_ptr<Queues> queues, int rank)
      : All(std::move(queues))
      , Own(rank)
    {
    }
    int Rank() const override { return this->Own; }
    int NumberOfRanks() const override { return this->All->Count; }

  protected:
    void Send(int to, const void* bytes, std::size_t count) override
    {
      const char* begin = static_cast<const char*>(bytes);
      const std::lock_guard<std::mutex> lock(this->All->Lock);
      this->All->From(this->Own, to).emplace_back(begin, begin + count);
      this->All->Arrived.notify_all();
    }
    void Receive(int from, void* bytes, std::size_t count) override
    {
      std::unique_lock<std::mutex> lock(this->All->Lock);
      std::deque<Message>& queue = this->All->From(from, this->Own);
      this->All->Arrived.wait(lock, [&queue] { return !queue.empty(); });
      Take(queue, bytes, count);
    }
    void ReceiveFromAny(void* bytes, std::size_t count) override
    {
      std::unique_lock<std::mutex> lock(this->All->Lock);
      int found = -1;
      this->All->Arrived.wait(lock,
        [&]
        {
          for (int from = 0; from < this->All->Count && found < 0; ++from)
          {
            found = this->All->From(from, this->Own).empty() ? -1 : from;
          }
          return found >= 0;
        });
      Take(this->All->From(found, this->Own), bytes, count);
    }

  private:
    static void Take(std::deque<Message>& queue, void* bytes, std::size_t count)
    {
      const Message message = std::move(queue.front());
      queue.pop_front();
      if (message.size() != count)
      {
        throw std::logic_error("what is received is not what was sent");
      }
      std::memcpy(bytes, message.data(), count);
    }
    std::shared_ptr<Queues> All;
    int Own;
  };
};
}

#endif

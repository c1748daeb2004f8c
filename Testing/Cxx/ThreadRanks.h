// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicThreadRanks_h
#define volumicThreadRanks_h

#include "Core/Common/Communicator.h"
#include "MessageQueues.h"

#include <exception>
#include <thread>

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
    const auto queues = std::make_shared<MessageQueues>(count);
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
  class Ranks final : public Communicator
  {
  public:
    Ranks(std::shared_ptr<MessageQueues> queues, int rank)
      : All(std::move(queues))
      , Own(rank)
    {
    }
    int Rank() const override { return this->Own; }
    int NumberOfRanks() const override { return this->All->NumberOfRanks(); }

  protected:
    void Send(int to, const void* bytes, std::size_t count) override
    {
      this->All->Send(this->Own, to, bytes, count);
    }
    void Receive(int from, void* bytes, std::size_t count) override
    {
      this->All->Receive(from, this->Own, bytes, count);
    }
    void ReceiveFromAny(void* bytes, std::size_t count) override
    {
      this->All->Receive(-1, this->Own, bytes, count);
    }

  private:
    std::shared_ptr<MessageQueues> All;
    int Own;
  };
};
}

#endif

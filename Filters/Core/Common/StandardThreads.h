// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStandardThreads_h
#define volumicStandardThreads_h

#include "Core/Common/Executor.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace volumic
{
/**
 * Threads of the standard library, for hosts that have no threads of their own to offer.
 *
 * The threads live as long as the object and sleep between two calls of For(). Where the system
 * gives fewer than wanted, as under a limit of memory, those do the work, at worst the calling
 * thread alone. Nothing that fails in a thread ends the program: the first exception of a body is
 * thrown again by For().
 */
class StandardThreads final : public Executor
{
public:
  /** @param numberOfThreads wanted, the calling one included. */
  explicit StandardThreads(int numberOfThreads);
  ~StandardThreads() override;
  StandardThreads(const StandardThreads&) = delete;
  StandardThreads& operator=(const StandardThreads&) = delete;

  /** Those that there are, the calling one included. */
  int NumberOfThreads() const { return static_cast<int>(this->Threads.size()) + 1; }

  /** @see Executor. For one caller at a time; within a body everything is done on its thread. */
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t, std::size_t)>& body) override;

  /** How often ForEach() tells how it goes. */
  static constexpr std::chrono::milliseconds Pause{ 50 };

  /**
   * Calls work(item) for 0 to n - 1, in this order, each item on one of the threads beside the
   * calling one, which calls tell() every Pause meanwhile; where there are no others it does all the
   * work, and tells nothing. An item may use other executors, but not this one. After an exception
   * of either no further item is begun; it is thrown again when those under way are done.
   */
  void ForEach(std::size_t n, const std::function<void(std::size_t item)>& work,
    const std::function<void()>& tell);

private:
  /** What the present call of For() is about. */
  struct Job
  {
    const std::function<void(std::size_t, std::size_t)>* Body = nullptr;
    std::size_t Next = 0; ///< The first item that nobody has taken.
    std::size_t End = 0;
    std::size_t Chunk = 1;
    std::exception_ptr Exception;
    bool IsOfItems = false; ///< ForEach(): a body may have threads of its own.
  };

  void Wait();
  void Help(std::unique_lock<std::mutex>& lock);
  /** Forgets the job, which is done. What it has thrown is thrown again. */
  void EndJob(std::unique_lock<std::mutex>& lock);

  std::mutex Mutex; ///< Of all that follows but Threads.
  std::condition_variable HasWork;
  std::condition_variable IsIdle;
  Job Present;
  int Helpers = 0; ///< Threads beside the calling one that are in a body.
  bool IsEnding = false;
  std::vector<std::thread> Threads;
};
}

#endif

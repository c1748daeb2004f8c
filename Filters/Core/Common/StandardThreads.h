// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStandardThreads_h
#define volumicStandardThreads_h

#include "Core/Common/Executor.h"

#include <atomic>
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
 * The threads of all work: those of the standard library, whatever threads the host has.
 *
 * They live as long as the object; between two calls of For() they look out for the next one for
 * some microseconds, then sleep. Where the system gives fewer than wanted, as under a limit of
 * memory, those do the work, at worst the calling thread alone. Nothing that fails in a thread ends
 * the program: the first exception of a body is thrown again by For().
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

private:
  void BeginJob(std::size_t n, std::size_t chunk,
    const std::function<void(std::size_t, std::size_t)>& body);
  void Wait();
  void Help();
  /** Waits until the job is done. What it has thrown is thrown again. */
  void EndJob();

  std::mutex Mutex; ///< Of all that follows but Threads; what is atomic is read without it, too.
  std::condition_variable HasWork;
  std::condition_variable IsIdle;
  std::atomic<unsigned> Jobs{ 0 };    ///< so far
  std::atomic<int> Helpers{ 0 };      ///< Threads beside the calling one that are in the job.
  std::atomic<std::size_t> Next{ 0 }; ///< The first item of the job that nobody has taken.
  std::size_t End = 0;                ///< Of the job: as the next ones, written while none helps.
  std::size_t Chunk = 1;
  const std::function<void(std::size_t, std::size_t)>* Body = nullptr;
  std::exception_ptr Exception;
  int Asleep = 0;
  bool IsEnding = false;
  std::vector<std::thread> Threads;
};
}

#endif

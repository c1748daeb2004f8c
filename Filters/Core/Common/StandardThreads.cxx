// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

namespace volumic
{
namespace
{
/** More than one per thread, as some take longer than others. */
constexpr std::size_t ChunksPerThread = 8;

/** How often a thread looks whether there is work, or it is done, before it sleeps. */
constexpr int Looks = 100;

/** Sleep and its end cost more than most calls of For(). Others get the processor all the same. */
template <typename Condition>
void LookOutFor(const Condition& hasCome)
{
  for (int look = 0; look < Looks && !hasCome(); ++look)
  {
    std::this_thread::yield();
  }
}

/** Whether this thread is within a body. */
thread_local bool isInBody = false;
}

StandardThreads::StandardThreads(int numberOfThreads)
{
  const auto wanted = static_cast<std::size_t>(std::max(numberOfThreads, 1) - 1);
  try
  {
    this->Threads.reserve(wanted);
    while (this->Threads.size() < wanted)
    {
      this->Threads.emplace_back([this] { this->Wait(); });
    }
  }
  catch (const std::system_error&)
  {
    // As many as the system gives.
  }
  catch (const std::bad_alloc&)
  {
  }
}

StandardThreads::~StandardThreads()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->IsEnding = true;
  }
  this->HasWork.notify_all();
  for (std::thread& thread : this->Threads)
  {
    thread.join();
  }
}

void StandardThreads::Wait()
{
  unsigned jobs = 0;
  for (;;)
  {
    LookOutFor([&] { return this->Jobs != jobs; });
    std::unique_lock<std::mutex> lock(this->Mutex);
    ++this->Asleep;
    this->HasWork.wait(lock, [this] { return this->IsEnding || this->Next < this->End; });
    --this->Asleep;
    if (this->IsEnding)
    {
      return;
    }
    jobs = this->Jobs;
    ++this->Helpers;
    lock.unlock();
    this->Help();
    lock.lock();
    if (--this->Helpers == 0)
    {
      this->IsIdle.notify_one();
    }
  }
}

void StandardThreads::BeginJob(std::size_t n, std::size_t chunk,
  const std::function<void(std::size_t, std::size_t)>& body)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Body = &body;
  this->End = n;
  this->Chunk = chunk;
  this->Next = 0;
  ++this->Jobs;
  // No more than find something to do beside the calling thread.
  const std::size_t wanted = (n + chunk - 1) / chunk - 1;
  for (std::size_t i = 0; i < std::min(wanted, static_cast<std::size_t>(this->Asleep)); ++i)
  {
    this->HasWork.notify_one();
  }
}

void StandardThreads::Help()
{
  for (std::size_t begin; (begin = this->Next.fetch_add(this->Chunk)) < this->End;)
  {
    isInBody = true;
    try
    {
      (*this->Body)(begin, std::min(begin + this->Chunk, this->End));
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Next = this->End; // Nothing more is begun.
      this->Exception = this->Exception ? this->Exception : std::current_exception();
    }
    isInBody = false;
  }
}

void StandardThreads::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (n == 0)
  {
    return;
  }
  if (isInBody || this->Threads.empty() || n <= grain)
  {
    body(0, n);
    return;
  }
  const std::size_t chunks = ChunksPerThread * (this->Threads.size() + 1);
  this->BeginJob(n, std::max({ grain, n / chunks, std::size_t(1) }), body);
  this->Help();
  LookOutFor([this] { return this->Helpers == 0; });
  this->EndJob();
}

void StandardThreads::EndJob()
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->IsIdle.wait(lock, [this] { return this->Next >= this->End && this->Helpers == 0; });
  const std::exception_ptr exception = std::exchange(this->Exception, nullptr);
  lock.unlock();
  if (exception)
  {
    std::rethrow_exception(exception);
  }
}
}

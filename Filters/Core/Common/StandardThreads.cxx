// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/StandardThreads.h"

#include <algorithm>
#include <new>
#include <system_error>

namespace volumic
{
namespace
{
/** More than one per thread, as some take longer than others. */
constexpr std::size_t ChunksPerThread = 8;

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
  std::unique_lock<std::mutex> lock(this->Mutex);
  for (;;)
  {
    this->HasWork.wait(
      lock, [this] { return this->IsEnding || this->Present.Next < this->Present.End; });
    if (this->IsEnding)
    {
      return;
    }
    ++this->Helpers;
    this->Help(lock);
    if (--this->Helpers == 0)
    {
      this->IsIdle.notify_one();
    }
  }
}

void StandardThreads::Help(std::unique_lock<std::mutex>& lock)
{
  Job& job = this->Present;
  while (job.Next < job.End)
  {
    const std::size_t begin = job.Next;
    const std::size_t end = begin + std::min(job.Chunk, job.End - begin);
    job.Next = end;
    lock.unlock();
    std::exception_ptr exception;
    isInBody = !job.IsOfItems;
    try
    {
      (*job.Body)(begin, end);
    }
    catch (...)
    {
      exception = std::current_exception();
    }
    isInBody = false;
    lock.lock();
    if (exception)
    {
      job.Next = job.End; // What is left is not worth doing.
      job.Exception = job.Exception ? job.Exception : exception;
    }
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
  std::unique_lock<std::mutex> lock(this->Mutex);
  const std::size_t chunks = ChunksPerThread * (this->Threads.size() + 1);
  this->Present = { &body, 0, n, std::max({ grain, n / chunks, std::size_t(1) }), nullptr, false };
  this->HasWork.notify_all();
  this->Help(lock);
  this->IsIdle.wait(lock, [this] { return this->Helpers == 0; });
  this->EndJob(lock);
}

void StandardThreads::ForEach(std::size_t n, const std::function<void(std::size_t item)>& work,
  const std::function<void()>& tell)
{
  const std::function<void(std::size_t, std::size_t)> body = [&work](std::size_t item, std::size_t)
  { work(item); };
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->Present = { &body, 0, n, 1, nullptr, true };
  this->HasWork.notify_all();
  if (this->Threads.empty())
  {
    this->Help(lock);
  }
  const auto isDone = [this]
  { return this->Present.Next == this->Present.End && this->Helpers == 0; };
  while (!this->IsIdle.wait_for(lock, Pause, isDone))
  {
    lock.unlock();
    std::exception_ptr exception;
    try
    {
      tell();
    }
    catch (...)
    {
      exception = std::current_exception();
    }
    lock.lock();
    if (exception)
    {
      this->Present.Next = this->Present.End;
      this->Present.Exception = exception;
      this->IsIdle.wait(lock, isDone);
    }
  }
  this->EndJob(lock);
}

void StandardThreads::EndJob(std::unique_lock<std::mutex>& lock)
{
  const std::exception_ptr exception = this->Present.Exception;
  this->Present = Job();
  lock.unlock();
  if (exception)
  {
    std::rethrow_exception(exception);
  }
}
}

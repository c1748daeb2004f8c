// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSideBySide_h
#define volumicSideBySide_h

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace volumic
{
/** Work on items, each on one thread, while the calling one tells how it goes. */
class SideBySide
{
public:
  /** How often the calling thread tells progress while others work. */
  static constexpr std::chrono::milliseconds Pause{ 50 };

  SideBySide(std::vector<std::size_t> items, std::function<void(std::size_t)> work)
    : Items(std::move(items)), Work(std::move(work))
  {
  }

  /** Whatever has ended Run(), the threads end before what they work on. */
  ~SideBySide() { this->Join(); }
  SideBySide(const SideBySide&) = delete;
  SideBySide& operator=(const SideBySide&) = delete;

  /** @param tell called on the calling thread now and then; what it throws goes on to the caller */
  void Run(int numberOfThreads, const std::function<void()>& tell)
  {
    this->Start(numberOfThreads);
    if (this->Threads.empty())
    {
      ++this->Running;
      this->WorkOn();
    }
    {
      std::unique_lock<std::mutex> lock(this->Mutex);
      while (!this->Finished.wait_for(lock, Pause, [this] { return this->Running == 0; }))
      {
        lock.unlock();
        tell();
        lock.lock();
      }
    }
    this->Join();
    if (this->Exception)
    {
      std::rethrow_exception(this->Exception);
    }
  }

private:
  /** Has no further item be begun, and waits for those that were. */
  void Join()
  {
    this->Next = this->Items.size();
    for (std::thread& thread : this->Threads)
    {
      thread.join();
    }
    this->Threads.clear();
  }

  void Start(int numberOfThreads)
  {
    try
    {
      for (int t = 0; t < numberOfThreads && this->Threads.size() < this->Items.size(); ++t)
      {
        ++this->Running;
        this->Threads.emplace_back([this] { this->WorkOn(); });
      }
    }
    catch (const std::system_error&)
    {
      --this->Running; // The system denies a thread: those that there are do the work.
    }
    catch (const std::bad_alloc&)
    {
      --this->Running; // As above; what memory the work needs, it asks for itself.
    }
  }

  void WorkOn()
  {
    try
    {
      for (std::size_t next = this->Next++; next < this->Items.size(); next = this->Next++)
      {
        this->Work(this->Items[next]);
      }
    }
    catch (...)
    {
      this->Next = this->Items.size();
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Exception = this->Exception ? this->Exception : std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(this->Mutex);
    --this->Running;
    this->Finished.notify_all();
  }

  std::vector<std::size_t> Items;
  std::vector<std::thread> Threads;
  std::function<void(std::size_t)> Work;
  std::atomic<std::size_t> Next{ 0 };
  std::atomic<int> Running{ 0 };
  std::mutex Mutex;
  std::condition_variable Finished;
  std::exception_ptr Exception;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Executor.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>

namespace volumic
{
namespace
{
/** More than one per thread, because chunks differ in cost. */
constexpr std::size_t ChunksPerThread = 8;

/**
 * The order of a loop for ThreadSanitizer, which does not see the synchronization of TBB: the
 * caller before all chunks before the caller.
 */
class VisibleOrder
{
public:
  VisibleOrder() { this->Begun.store(true, std::memory_order_release); }
  ~VisibleOrder() { this->Ended.load(std::memory_order_acquire); }
  VisibleOrder(const VisibleOrder&) = delete;
  VisibleOrder& operator=(const VisibleOrder&) = delete;

  struct Chunk
  {
    explicit Chunk(VisibleOrder& order) : Order(order)
    {
      this->Order.Begun.load(std::memory_order_acquire);
    }
    ~Chunk() { this->Order.Ended.fetch_add(1, std::memory_order_release); }
    VisibleOrder& Order;
  };

private:
  std::atomic<bool> Begun{ false };
  std::atomic<int> Ended{ 0 };
};
}

class Executor::Arena : public tbb::task_arena
{
public:
  using tbb::task_arena::task_arena;
};

Executor::Executor(int numberOfThreads)
  : Number(std::max(numberOfThreads, 1)),
    Threads(this->Number > 1 ? std::make_shared<Arena>(this->Number) : nullptr)
{
}

Executor::~Executor() = default;

void Executor::Execute(const std::function<void()>& work)
{
  this->Threads->execute(work);
}

void Executor::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (!this->Threads || n <= std::max(grain, std::size_t(1)))
  {
    if (n > 0)
    {
      body(0, n);
    }
    return;
  }
  const std::size_t chunks = ChunksPerThread * static_cast<std::size_t>(this->Number);
  const std::size_t size = std::max({ grain, n / chunks, std::size_t(1) });
  VisibleOrder order;
  const auto chunk = [&](std::size_t i)
  {
    const VisibleOrder::Chunk ordered(order);
    body(i * size, std::min(n, (i + 1) * size));
  };
  const auto loop = [&]
  {
    // Isolated: a failure elsewhere must not skip chunks of a loop whose caller continues.
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::parallel_for(
      std::size_t(0), (n + size - 1) / size, chunk, tbb::simple_partitioner(), context);
  };
  this->Execute([&loop] { tbb::this_task_arena::isolate(loop); });
}
}

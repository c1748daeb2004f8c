// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVisitTestTools_h
#define volumicVisitTestTools_h

#include "Core/Common/VisitSchedule.h"
#include "TestPrelude.h"

#include <chrono>
#include <thread>

namespace volumic
{
using Body = std::function<void(std::size_t begin, std::size_t end)>;

/** From 0 on. */
inline std::vector<int> InOrder(int n)
{
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/** Items that do not touch. */
inline VisitSchedule Apart(int n)
{
  return VisitSchedule(InOrder(n), [](int) { return std::vector<int>(); });
}

inline bool Always(std::size_t)
{
  return true;
}

/** Waits for something that is sure to come; @return whether it has, on a machine however slow. */
template <typename Condition>
bool HasCome(const Condition& condition)
{
  const auto start = std::chrono::steady_clock::now();
  while (!condition())
  {
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(20))
    {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

/** For as a test says. */
class ToldExecutor : public Executor
{
public:
  explicit ToldExecutor(std::function<void(std::size_t n, const Body& body)> way)
    : Way(std::move(way))
  {
  }
  void For(std::size_t n, std::size_t, const Body& body) override
  {
    ++this->Calls;
    this->Way(n, body);
  }

  int Calls = 0;

private:
  std::function<void(std::size_t, const Body&)> Way;
};

/** For by a thread of its own, while the calling one waits. */
inline void OnAnotherThread(std::size_t n, const Body& body)
{
  std::thread thread([&] { body(0, n); });
  thread.join();
}
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStopwatch_h
#define volumicStopwatch_h

#include "Core/Evolution/SurfaceEvolution.h"

#include <chrono>

namespace volumic
{
/** Adds the time since it was made, or since the last call, to a phase. */
class Stopwatch
{
public:
  /** The row must outlive the object. */
  explicit Stopwatch(HistoryRow& row) : Row(row), Last(Clock::now()) {}

  void Lap(Phase phase)
  {
    const Clock::time_point now = Clock::now();
    this->Row.PhaseSeconds[static_cast<int>(phase)] +=
      std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
  }

private:
  using Clock = std::chrono::steady_clock;

  HistoryRow& Row;
  Clock::time_point Last;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicStopwatch_h
#define volumicStopwatch_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceEvolution.h"

#include <chrono>
#include <cstddef>

namespace volumic
{
/** As Executor::EndPhase() is told. */
inline const char* Describe(Phase phase)
{
  constexpr const char* names[] = { "Forces", "Contact", "Proximity", "Verification", "Remeshing",
    "Topology", "Division", "Recovery", "Regularisation" };
  static_assert(sizeof names / sizeof *names == static_cast<std::size_t>(Phase::Count));
  return names[static_cast<int>(phase)];
}

/** Adds the time since it was made, or since the last call, to a phase. */
class Stopwatch
{
public:
  /** Both must outlive the object. */
  Stopwatch(HistoryRow& row, Executor& executor)
    : Row(row)
    , Threads(executor)
    , LastInside(executor.SecondsInside())
    , Last(Clock::now())
  {
  }

  void Lap(Phase phase)
  {
    const Clock::time_point now = Clock::now();
    const double inside = this->Threads.SecondsInside();
    const double seconds = std::chrono::duration<double>(now - this->Last).count();
    PhaseTime& time = this->Row.Phases[static_cast<int>(phase)];
    time.Seconds += seconds;
    time.Serial += seconds - (inside - this->LastInside);
    this->Last = now;
    this->LastInside = inside;
    this->Threads.EndPhase(Describe(phase));
  }

private:
  using Clock = std::chrono::steady_clock;

  HistoryRow& Row;
  Executor& Threads;
  double LastInside;
  Clock::time_point Last;
};
}

#endif

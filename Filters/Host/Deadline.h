// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicDeadline_h
#define volumicDeadline_h

#include <chrono>

namespace volumic
{
/** When a run must end. */
class Deadline
{
public:
  using Clock = std::chrono::steady_clock;

  /**
   * @param start when the run began
   * @param limit seconds from then on; 0: none
   */
  explicit Deadline(Clock::time_point start = Clock::now(), double limit = 0.0)
    : Start(start)
    , Limit(limit)
  {
  }

  bool IsOver() const
  {
    return this->Limit > 0.0 &&
      std::chrono::duration<double>(Clock::now() - this->Start).count() >= this->Limit;
  }

private:
  Clock::time_point Start;
  double Limit;
};
}

#endif

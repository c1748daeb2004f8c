// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicProgressMonitor_h
#define volumicProgressMonitor_h

#include "Core/Common/Monitor.h"

#include <chrono>
#include <functional>
#include <string>

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
    : Start(start), Limit(limit)
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

/**
 * Tells the host of the work on the levels, as a share of the whole that never becomes less, and
 * the core whether the host has asked to stop, or time is over. It is the one place that ends a run
 * early.
 */
class ProgressMonitor final : public Monitor
{
public:
  /** Told the share of the work that is done, and what is being done; false asks to stop. */
  using Callback = std::function<bool(double share, const std::string& text)>;

  /**
   * From the level `coarsest` to the level `finest`. A level has about three times the vertices of
   * the one above, and takes so much more of the work.
   */
  ProgressMonitor(Callback callback, int coarsest, int finest, const Deadline& limit = Deadline());

  bool GoOn(const Status& status) override;

  /** Before the voxels of a level are made ready; false asks to stop. */
  bool BeginLevel(int level);

  /** There is another level to come, after which the share that is done is less. */
  void GoOnTo(int finest) { this->Finest = finest; }

  bool IsStopped() const { return this->Stopped; }

  /** Whether it was time that has stopped it, and not the host. */
  bool IsOutOfTime() const { return this->OutOfTime; }

private:
  bool Report(int level, double fraction, const std::string& text);

  Callback Host;
  int Coarsest;
  int Finest;
  Deadline Limit;
  bool Stopped = false;
  bool OutOfTime = false;
};
}

#endif

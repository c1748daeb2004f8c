// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunObserver_h
#define volumicRunObserver_h

#include "Core/Common/Monitor.h"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace volumic
{
/** Report the finished share of the work, in [0, 1], and its current step. Return false to stop. */
using Progress = std::function<bool(double share, const std::string& text)>;

/**
 * Observes a run for its filter. All progress and all warnings of a run pass through it. It stops
 * the run if the filter is aborted or the time limit is exceeded.
 */
class RunObserver
{
public:
  using Clock = std::chrono::steady_clock;

  /**
   * Start the clock of the run.
   * @param timeLimit in seconds, from now on (0: none)
   * @param warnings  receives the texts of Warn()
   * @throws Refusal if the limit is negative or NaN
   */
  RunObserver(vtkAlgorithm* filter, double timeLimit, std::vector<std::string>& warnings);

  /** Set the progress of the filter. Return false if the run must stop, from then on always. */
  bool GoOn(double share, const std::string& text);
  /** Return whether the run must stop. */
  bool IsStopped();
  /** Return the `StopReason` of a stopped run: "time limit" or "cancelled". */
  std::string StopReason() const;

  Clock::time_point Start() const { return this->Started; }

  /**
   * Collect a warning for the end of the run: ParaView's message box would cover the progress bar.
   * Empty texts and repeated ones are ignored.
   */
  void Warn(const std::string& text);

private:
  vtkAlgorithm* Filter;
  double TimeLimit;
  Clock::time_point Started = Clock::now();
  bool IsAborted = false;
  bool IsOutOfTime = false;
  std::vector<std::string>& PendingWarnings;
};

/** Reports the progress of the core on the levels to an observer. The share never decreases. */
class LevelMonitor final : public Monitor
{
public:
  /**
   * Monitor the levels from `coarsest` to `finest`. Each takes about three times the work of the
   * next coarser level, as it has three times the vertices.
   * @param before share of the work before the first of these levels
   */
  LevelMonitor(RunObserver& observer, double before, int coarsest, int finest)
    : Observer(observer), Before(before), Coarsest(coarsest), Finest(finest)
  {
  }

  bool GoOn(const Status& status) override;

  /** Report that a level begins, before its voxels are loaded. Return false to stop. */
  bool BeginLevel(int level);

  /** Add the levels down to `finest`. */
  void ContinueAtLevel(int finest) { this->Finest = finest; }

private:
  bool Report(int level, double fraction, const std::string& text);

  RunObserver& Observer;
  double Before;
  int Coarsest;
  int Finest;
};
}

#endif

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
/** Report the finished fraction of the work, in [0, 1], and its step. Return false to stop. */
using Progress = std::function<bool(double fraction, const std::string& text)>;

/**
 * Observer of a run. It forwards progress to the filter, collects warnings, and stops the run if
 * the filter is aborted or the time limit is exceeded.
 */
class RunObserver
{
public:
  using Clock = std::chrono::steady_clock;

  /**
   * Start the clock of the run.
   * @param timeLimit seconds, 0 for none
   * @param warnings  receives the texts of Warn()
   * @throws InvalidArgument if the limit is negative or NaN
   */
  RunObserver(vtkAlgorithm* filter, double timeLimit, std::vector<std::string>& warnings);

  /** Set the progress of the filter. Return false if the run must stop. */
  bool ReportProgress(double fraction, const std::string& text);
  /** Return whether the run must stop. Once it is true, it remains true. */
  bool IsStopped();
  /** Return the `StopReason` of a stopped run: "time limit" or "cancelled". */
  const char* StopReason() const { return this->IsOutOfTime ? "time limit" : "cancelled"; }

  Clock::time_point Start() const { return this->Started; }

  /**
   * Add a warning to report after the run, unless it is empty or repeated. ParaView's message box
   * would cover the progress bar.
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

/** Monitor that reports the progress on the levels to an observer. It never decreases. */
class LevelMonitor final : public Monitor
{
public:
  /**
   * Monitor the levels `coarsest` to `finest`. Each takes about three times as long as the last.
   * @param before fraction of the work before the first of these levels
   */
  LevelMonitor(RunObserver& observer, double before, int coarsest, int finest)
    : Observer(observer), Before(before), Coarsest(coarsest), Finest(finest)
  {
  }

  bool GoOn(const Status& status) override;

  /** Report that a level begins, before its voxels are loaded. Return false to stop. */
  bool BeginLevel(int level);

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

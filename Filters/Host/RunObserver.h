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
/**
 * Told the share of some work that is done, in [0, 1], and what is being done; false asks to stop.
 */
using Progress = std::function<bool(double share, const std::string& text)>;

/** `StopReason` of what a run hands over that has come to the end of its time. */
constexpr const char* TimeLimitReason = "time limit";

/**
 * The filter that a run works for. It is the one place where the work tells how far it is and what
 * is worth a warning, and hears that it is to stop: as the host asks for it, or as time is over.
 */
class RunObserver
{
public:
  using Clock = std::chrono::steady_clock;

  /**
   * The run begins now.
   * @param timeLimit seconds from now on; 0: none
   * @param warnings  takes what Warn() is told
   * @throws std::invalid_argument if the limit is neither
   */
  RunObserver(vtkAlgorithm* filter, double timeLimit, std::vector<std::string>& warnings);

  /** Sets the progress of the filter. @return false: stop, from then on always */
  bool GoOn(double share, const std::string& text);
  /** Whether the work is to stop, now or before. */
  bool IsStopped();
  /** `StopReason` after a stop: by the host, or by time. */
  std::string StopReason() const;

  Clock::time_point Start() const { return this->Started; }

  /** For the end of the run, once: ParaView's message box would cover the progress bar. */
  void Warn(const std::string& text);

private:
  vtkAlgorithm* Filter;
  double TimeLimit;
  Clock::time_point Started = Clock::now();
  bool IsAborted = false;
  bool IsOutOfTime = false;
  std::vector<std::string>& Untold;
};

/**
 * Tells an observer of the work on the levels, as a share of the whole that never becomes less.
 */
class LevelMonitor final : public Monitor
{
public:
  /**
   * From the level `coarsest` to the level `finest`. A level has about three times the vertices of
   * the one above, and takes so much more of the work.
   * @param before share of the work that was done before the first of them
   */
  LevelMonitor(RunObserver& observer, double before, int coarsest, int finest)
    : Observer(observer), Before(before), Coarsest(coarsest), Finest(finest)
  {
  }

  bool GoOn(const Status& status) override;

  /** Before the voxels of a level are made ready; false asks to stop. */
  bool BeginLevel(int level);

  /** There is another level to come, after which the share that is done is less. */
  void GoOnTo(int finest) { this->Finest = finest; }

private:
  bool Report(int level, double fraction, const std::string& text);

  RunObserver& Observer;
  double Before;
  int Coarsest;
  int Finest;
};
}

#endif

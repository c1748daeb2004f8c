// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/RunObserver.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Host/Pipeline.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Sweeps of at least this number of blocks may take long, so progress names the block. */
constexpr int ManyBlocks = 500;

std::string BlocksOf(const Monitor::Status& status)
{
  return status.Block > 0 && status.Blocks >= ManyBlocks
    ? Join(", block ", status.Block, " of ", status.Blocks)
    : "";
}

std::string TextOf(const Monitor::Status& status)
{
  const bool isIterating = status.Doing == Monitor::Activity::Iterating;
  if (isIterating || status.Doing == Monitor::Activity::Regularising)
  {
    return (isIterating ? Join("iteration ", status.Iteration) : "optimization") + BlocksOf(status);
  }
  return status.Doing == Monitor::Activity::Starting ? "start"
    : status.Doing == Monitor::Activity::Dividing    ? "subdivision"
                                                     : "recovery";
}
}

RunObserver::RunObserver(vtkAlgorithm* filter, double timeLimit, std::vector<std::string>& warnings)
  : Filter(filter), TimeLimit(timeLimit), PendingWarnings(warnings)
{
  if (!(timeLimit >= 0.0))
  {
    ThrowInvalidArgument("Time Limit is ", timeLimit, ". Set it to 0 (none) or more seconds.");
  }
}

bool RunObserver::ReportProgress(double fraction, const std::string& text)
{
  this->Filter->SetProgressText(text.c_str());
  this->Filter->UpdateProgress(fraction);
  return !this->IsStopped();
}

bool RunObserver::IsStopped()
{
  this->IsAborted = this->IsAborted || IsAbortRequested(this->Filter);
  this->IsOutOfTime = this->IsOutOfTime ||
    (!this->IsAborted && this->TimeLimit > 0.0 &&
      std::chrono::duration<double>(Clock::now() - this->Started).count() >= this->TimeLimit);
  return this->IsAborted || this->IsOutOfTime;
}

void RunObserver::Warn(const std::string& text)
{
  if (!text.empty() &&
    std::find(this->PendingWarnings.begin(), this->PendingWarnings.end(), text) ==
      this->PendingWarnings.end())
  {
    this->PendingWarnings.push_back(text);
  }
}

bool LevelMonitor::GoOn(const Status& status)
{
  return this->Report(status.Level, status.Fraction,
    Join("Level ", status.Level, ", ", TextOf(status), ", ", status.Vertices, " vertices"));
}

bool LevelMonitor::BeginLevel(int level)
{
  // Name the finished level, as a user who cancels here gets its surface.
  return this->Report(level, 0.0,
    level == this->Coarsest ? Join("Level ", level, ", voxels")
                            : Join("Level ", level + 1, " is done"));
}

bool LevelMonitor::Report(int level, double fraction, const std::string& text)
{
  double done = 0.0;
  double total = 0.0;
  for (int other = this->Coarsest; other >= this->Finest; --other)
  {
    const double weight = std::pow(3.0, this->Coarsest - other);
    done += other > level ? weight : 0.0;
    total += weight;
  }
  done += std::pow(3.0, this->Coarsest - level) * std::clamp(fraction, 0.0, 1.0);
  return this->Observer.ReportProgress(this->Before + (1.0 - this->Before) * done / total, text);
}
}

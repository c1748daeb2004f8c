// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/ProgressMonitor.h"

#include "Core/Common/Refuse.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace volumic
{
namespace
{
/** Blocks from which on a sweep may take so long that one wants to know how far it is. */
constexpr int ManyBlocks = 500;

std::string BlocksOf(const Monitor::Status& status)
{
  return status.Block > 0 && status.Blocks >= ManyBlocks
    ? Join(", block ", status.Block, " of ", status.Blocks)
    : "";
}

std::string TextOf(const Monitor::Status& status)
{
  switch (status.Doing)
  {
    case Monitor::Activity::Starting:
      return "start";
    case Monitor::Activity::Dividing:
      return "division";
    case Monitor::Activity::Recovering:
      return "search for lost parts";
    case Monitor::Activity::Iterating:
      return Join("iteration ", status.Iteration, BlocksOf(status));
    default:
      return "regularisation" + BlocksOf(status);
  }
}
}

ProgressMonitor::ProgressMonitor(Callback callback, int coarsest, int finest, const Deadline& limit)
  : Host(std::move(callback)), Coarsest(coarsest), Finest(finest), Limit(limit)
{
}

bool ProgressMonitor::GoOn(const Status& status)
{
  return this->Report(status.Level, status.Fraction,
    Join("Level ", status.Level, ", ", TextOf(status), ", ", status.Vertices, " vertices"));
}

bool ProgressMonitor::BeginLevel(int level)
{
  // Who stops at the name of a level expects to get the surface of that level.
  return this->Report(level, 0.0,
    level == this->Coarsest ? Join("Level ", level, ", voxels")
                            : Join("Level ", level + 1, " is done"));
}

bool ProgressMonitor::Report(int level, double fraction, const std::string& text)
{
  double before = 0.0;
  double total = 0.0;
  for (int other = this->Coarsest; other >= this->Finest; --other)
  {
    const double weight = std::pow(3.0, this->Coarsest - other);
    before += other > level ? weight : 0.0;
    total += weight;
  }
  const double own = std::pow(3.0, this->Coarsest - level);
  const double share = (before + own * std::clamp(fraction, 0.0, 1.0)) / total;
  this->Stopped = this->Stopped || !this->Host(share, text);
  if (!this->Stopped && this->Limit.IsOver())
  {
    this->Stopped = this->OutOfTime = true;
  }
  return !this->Stopped;
}
}

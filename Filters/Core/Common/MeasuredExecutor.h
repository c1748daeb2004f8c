// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicMeasuredExecutor_h
#define volumicMeasuredExecutor_h

#include "Core/Common/Executor.h"

#include <cstddef>
#include <functional>

namespace volumic
{
/**
 * Hands all on to another executor and keeps the seconds of the clock that this takes, so that what
 * is left of a phase is known to be the work of one thread alone.
 *
 * Counted are the calls that are not within a body: those within one are a part of it.
 */
class MeasuredExecutor final : public Executor
{
public:
  /** @param executor must outlive the object. */
  explicit MeasuredExecutor(Executor& executor)
    : Measured(executor)
  {
  }

  /** @see Executor. For one caller at a time. */
  void For(std::size_t n, std::size_t grain,
    const std::function<void(std::size_t begin, std::size_t end)>& body) override;
  bool MakeVisits(const VisitSchedule& schedule, const VisitBody& visit) override;
  double SecondsInside() const override { return this->Seconds; }
  void EndPhase(const char* name) override { this->Measured.EndPhase(name); }

private:
  template <typename Work>
  auto Measure(Work&& work);

  Executor& Measured;
  double Seconds = 0.;
  bool IsInside = false; ///< Written by the caller while no body runs, read within bodies.
};
}

#endif

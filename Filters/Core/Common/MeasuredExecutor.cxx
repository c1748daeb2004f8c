// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/MeasuredExecutor.h"

#include <chrono>

namespace volumic
{
template <typename Work>
auto MeasuredExecutor::Measure(Work&& work)
{
  if (this->IsInside)
  {
    return work();
  }
  /** Ends the measurement also where the body throws. */
  struct Measurement
  {
    explicit Measurement(MeasuredExecutor& executor)
      : Self(executor)
    {
      this->Self.IsInside = true;
    }
    ~Measurement()
    {
      this->Self.IsInside = false;
      this->Self.Seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
    }
    MeasuredExecutor& Self;
    std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  };
  const Measurement measurement(*this);
  return work();
}

void MeasuredExecutor::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  this->Measure([&] { this->Measured.For(n, grain, body); });
}

bool MeasuredExecutor::MakeVisits(const VisitSchedule& schedule, const VisitBody& visit)
{
  return this->Measure([&] { return this->Measured.MakeVisits(schedule, visit); });
}
}

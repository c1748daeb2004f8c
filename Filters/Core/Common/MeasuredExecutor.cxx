// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/MeasuredExecutor.h"

#include <chrono>

namespace volumic
{
void MeasuredExecutor::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  if (this->IsInside)
  {
    this->Measured.For(n, grain, body);
    return;
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
  this->Measured.For(n, grain, body);
}
}

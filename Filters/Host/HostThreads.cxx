// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Host/HostThreads.h"

#include "Core/Common/ScratchMemory.h"
#include "Core/Common/StandardThreads.h"
#include "Host/Processors.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace volumic
{
namespace
{
/** See HostThreads::UseInstead. */
Executor* theInstead = nullptr;

int NumberOf(int wanted)
{
  int number = NumberOfProcessors();
  if (wanted > 0)
  {
    return std::min(number, wanted);
  }
  const auto limit = [&number](int most) { number = most > 0 ? std::min(number, most) : number; };
  limit(QuotaOfProcessors());
  const char* most = std::getenv("VTK_SMP_MAX_THREADS");
  limit(most ? std::atoi(most) : 0);
  // One thread is what is left of VTK, not what the host wants.
  if (std::string(vtkSMPTools::GetBackend()) != "Sequential")
  {
    limit(vtkSMPTools::GetEstimatedNumberOfThreads());
  }
  return number;
}
}

HostThreads::HostThreads(int numberOfThreads) : Number(NumberOf(numberOfThreads)) {}

void HostThreads::UseInstead(Executor* executor)
{
  theInstead = executor;
}

void HostThreads::Run(const std::function<void()>& work)
{
  if (this->Threads)
  {
    work();
    return;
  }
  struct End
  {
    ~End() { this->Threads.reset(); }
    std::unique_ptr<Executor>& Threads;
  } const end{ this->Threads };
  this->Threads = std::make_unique<StandardThreads>(this->Number);
  work();
}

void HostThreads::For(
  std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
  Executor& threads = !this->Threads ? OnThisThread() : theInstead ? *theInstead : *this->Threads;
  if (!HasMemoryLimit())
  {
    threads.For(n, grain, body);
    return;
  }
  // Room is waited for step by step, however large the level is: an item that looks at a voxel or
  // two may bring in 16 pages with each, so that 12,000 of them are more than all that is free.
  const std::size_t step = std::max(grain / 8, std::size_t(1));
  threads.For(n, grain,
    [&](std::size_t begin, std::size_t end)
    {
      for (; begin < end; begin += step)
      {
        KeepMemoryLimit();
        body(begin, std::min(end, begin + step));
      }
    });
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "PeakMemory.h"

#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace volumic::bench
{
namespace
{

/** A line of /proc/self/status, in bytes; -1 without it. */
long long StatusBytes(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
  {
    if (word == name + ":")
    {
      long long kilobytes = -1;
      return status >> kilobytes ? kilobytes * 1024 : -1;
    }
  }
  return -1;
}

} // namespace

MemoryUse MeasureMemory(const std::function<void()>& run)
{
#if defined(__GLIBC__)
  malloc_trim(0); // memory that was freed before must not serve what is measured
#endif
  bool peakStartsAgain = false;
  {
    std::ofstream refs("/proc/self/clear_refs");
    refs << "5"; // the peak starts again from what is resident now
    refs.flush();
    peakStartsAgain = static_cast<bool>(refs);
  }
  MemoryUse use;
  use.Before = StatusBytes("VmRSS");
  run();
  use.Peak = peakStartsAgain ? StatusBytes("VmHWM") : -1;
  return use;
}

long long PeakGrowth(const std::function<void()>& run)
{
  const MemoryUse use = MeasureMemory(run);
  return use.Before < 0 || use.Peak < 0 ? -1 : use.Peak - use.Before;
}

} // namespace volumic::bench

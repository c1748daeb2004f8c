// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How far the memory of this process grows while something runs. */

#ifndef volumicPeakMemory_h
#define volumicPeakMemory_h

#include <functional>

namespace volumic::bench
{

/** Bytes by which the resident memory at its peak exceeded what was resident before. -1 where the
    system does not tell (it is Linux that does). */
long long PeakGrowth(const std::function<void()>& run);

/** Resident memory of the whole process, in bytes, with its libraries and all that it holds: before
    something ran, and at the peak while it ran. -1 where the system does not tell. */
struct MemoryUse
{
  long long Before = -1;
  long long Peak = -1;
};

MemoryUse MeasureMemory(const std::function<void()>& run);

} // namespace volumic::bench

#endif

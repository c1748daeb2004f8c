// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** How far the memory of this process grows while something runs. */

#ifndef PeakMemory_h
#define PeakMemory_h

#include <functional>

namespace volumic
{
namespace bench
{

/** Bytes by which the resident memory at its peak exceeded what was resident before. -1 where the
    system does not tell (it is Linux that does). */
long long PeakGrowth(const std::function<void()>& run);

} // namespace bench
} // namespace volumic

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSort_h
#define volumicSort_h

#include "Core/Common/Executor.h"

#include <tbb/parallel_sort.h>

namespace volumic
{
/** Sort in parallel. Equal values must be interchangeable. Do not call it within a loop's body. */
template <typename Values>
void Sort(Executor& executor, Values& values)
{
#ifndef __SANITIZE_THREAD__ // It would not see how TBB passes values to other threads.
  if (executor.NumberOfThreads() > 1)
  {
    executor.Execute([&values] { tbb::parallel_sort(values.begin(), values.end()); });
    return;
  }
#endif
  std::sort(values.begin(), values.end());
}
}

#endif

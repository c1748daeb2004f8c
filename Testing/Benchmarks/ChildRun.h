// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** Runs this very program again, as a process of its own. */

#ifndef volumicChildRun_h
#define volumicChildRun_h

#include "RunFigures.h"

#include <string>
#include <vector>

namespace volumic
{
namespace bench
{

/** Starts this program anew with `arguments`, waits for it and takes over the figures that it
   writes to its standard output; its standard error is ours. A process of its own, started and not
   merely forked, so that neither memory nor caches nor threads of one run are there in the next.
   A run that fails has the text `Failure`: what it told itself, or how it ended. Throws
   std::runtime_error where no process can be started. */
RunFigures RunAsChild(const std::vector<std::string>& arguments);

/** For the process started so: it ends when who started it does. */
void EndWithParent();

} // namespace bench
} // namespace volumic

#endif

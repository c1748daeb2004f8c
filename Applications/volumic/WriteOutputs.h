// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicWriteOutputs_h
#define volumicWriteOutputs_h

#include "ProgressLine.h"

namespace tool
{
class Ranks;
struct ReportInput;
struct ToolOptions;

/**
 * All that can be known to be wrong with the files before the work begins.
 * @throws Failure or UsageError that says what.
 */
void CheckFiles(const ToolOptions& options);

/**
 * Write all that the options ask for, but the volume. With many ranks all of them call this: the
 * first writes, what is in pieces each rank. @param results their sizes are set here
 * @throws Failure if not all could be written, with a line for each file.
 */
void WriteOutputs(
  const ToolOptions& options, ReportInput& results, ProgressStyle style, Ranks& ranks);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentLabels_h
#define volumicSegmentLabels_h

#include "ToolErrors.h"

namespace tool
{
class Ranks;
struct FilterTrio;
struct ToolOptions;

/**
 * Read a label map, find a surface about each of the labels that are asked for, and write what the
 * options ask for. By all ranks, which share the labels; the first one reads and writes.
 * @param filters with their properties set
 * @return Success or Unfinished
 * @throws Failure where a file cannot be read or written, a label is not there, or no label has a
 * surface.
 */
ExitCode SegmentLabels(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks);
}

#endif

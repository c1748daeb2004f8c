// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentVolume_h
#define volumicSegmentVolume_h

#include "ToolErrors.h"

namespace tool
{
class Ranks;
struct FilterTrio;
struct ToolOptions;

/**
 * Read the volume, find the surface unless the volume is all that is to be written, and write what
 * the options ask for.
 * @param filters with their properties set; that of the surface is a vtkVolumeToSurface where the
 * length of the edges decides on the pyramid.
 * @param ranks all of which call this; the first one reads and writes what has no parts.
 * @return Success or Unfinished, the same on all ranks.
 * @throws Failure where a file cannot be read or written, or the surface vanished.
 */
ExitCode SegmentVolume(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegment_h
#define volumicSegment_h

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
 * @return Success or Unfinished
 * @throws Failure where a file cannot be read or written, or the surface vanished.
 */
ExitCode SegmentVolume(const ToolOptions& options, const FilterTrio& filters);

/**
 * Read a label map, find a surface about each of the labels that are asked for, and write what the
 * options ask for. By the first rank; the others share the labels.
 * @param filters with their properties set
 * @return Success or Unfinished
 * @throws Failure where a file cannot be read or written, a label is not there, or no label has a
 * surface.
 */
ExitCode SegmentLabels(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks);

/** At the other ranks, until the first one is through. @return its exit code */
int HelpWithLabels(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks);
}

#endif

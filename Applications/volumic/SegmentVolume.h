// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentVolume_h
#define volumicSegmentVolume_h

#include "ToolErrors.h"

class vtkDeformableSurface;
class vtkImagePyramid;

namespace tool
{
class Ranks;
struct ToolOptions;

/**
 * Read the volume, find the surface unless the volume is all that is to be written, and write what
 * the options ask for.
 * @param pyramid, filter with their properties set; the second is a vtkVolumeToSurface where the
 * length of the edges decides on the pyramid.
 * @param ranks all of which call this; the first one reads and writes what has no parts.
 * @return Success or Unfinished, the same on all ranks.
 * @throws Failure where a file cannot be read or written, or the surface vanished.
 */
ExitCode SegmentVolume(const ToolOptions& options, vtkImagePyramid* pyramid,
  vtkDeformableSurface* filter, Ranks& ranks);
}

#endif

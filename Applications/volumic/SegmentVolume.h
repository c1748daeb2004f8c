// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentVolume_h
#define volumicSegmentVolume_h

#include "ToolErrors.h"

class vtkDeformableSurface;
class vtkImagePyramid;

namespace tool
{
struct ToolOptions;

/**
 * Read the volume, find the surface unless the volume is all that is to be written, and write what
 * the options ask for.
 * @param pyramid, filter with their properties set; the second is a vtkVolumeToSurface where the
 * length of the edges decides on the pyramid.
 * @return Success or Unfinished.
 * @throws Failure where a file cannot be read or written, or the surface vanished.
 */
ExitCode SegmentVolume(
  const ToolOptions& options, vtkImagePyramid* pyramid, vtkDeformableSurface* filter);
}

#endif

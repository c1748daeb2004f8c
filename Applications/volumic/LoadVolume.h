// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLoadVolume_h
#define volumicLoadVolume_h

#include <vtkSmartPointer.h>

class vtkImageData;

namespace tool
{
class Announcer;
struct ToolOptions;

/**
 * Read the volume of the command line, choose its array, set its spacing, and tell what it is.
 * @param component of its voxels of which the range is told, -1: the magnitude
 * @throws Failure if it cannot be read or lacks the array.
 */
vtkSmartPointer<vtkImageData> LoadVolume(
  const ToolOptions& options, int component, const Announcer& announcer);
}

#endif

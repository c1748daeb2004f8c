// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLoadVolume_h
#define volumicLoadVolume_h

#include <vtkSmartPointer.h>

#include <string>

class vtkDeformableSurface;
class vtkImageData;
class vtkImagePyramid;

namespace tool
{
class Announcer;
struct ToolOptions;

/**
 * Read the volume of the command line, choose its array, set its spacing, and tell what it is.
 * Where the memory is limited it is read slab by slab into scratch memory; the voxels are those of
 * the selected component then.
 * @param filter of which the component and the memory limit are taken
 * @param holder a pyramid for this purpose: the scratch memory lasts as long as it does
 * @throws Failure if it cannot be read or lacks the array.
 */
vtkSmartPointer<vtkImageData> LoadVolume(const ToolOptions& options, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer);

/** The part that reads: any volume, of which the array is the active scalars. */
vtkSmartPointer<vtkImageData> LoadVoxels(const std::string& name, const std::string& array,
  vtkDeformableSurface* filter, vtkImagePyramid* holder, const Announcer& announcer);
}

#endif

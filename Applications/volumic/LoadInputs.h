// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLoadInputs_h
#define volumicLoadInputs_h

#include "ReadVolume.h"
#include "VolumeFacts.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDeformableSurface;
class vtkImageData;
class vtkImagePyramid;

namespace tool
{
class Announcer;
struct ToolOptions;

/** The volume of the command line. */
struct LoadedVolume
{
  vtkSmartPointer<vtkImageData> Image;
  VolumeFacts Facts;
};

/**
 * Read the volume of the command line, choose its array, set its spacing, and tell what it is.
 * Where the memory is limited it is read slab by slab into scratch memory; the voxels are those of
 * the selected component then.
 * @param filter of which the component and the memory limit are taken; a map of edges becomes its
 * @param holder a pyramid for this purpose: the scratch memory lasts as long as it does
 * @throws Failure if it cannot be read or lacks the array.
 */
LoadedVolume LoadVolume(const ToolOptions& options, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer);

/** A volume whose active scalars are the array that is wanted. */
struct LoadedVoxels
{
  vtkSmartPointer<vtkImageData> Image;
  int Components = 1; ///< that the file has; with a limit the image has the selected one
};

/** Any volume as a whole, with warnings of what its file says and is not followed. */
vtkSmartPointer<vtkImageData> LoadWhole(const std::string& name, const std::string& array,
  const VolumeChoice& choice, const Announcer& announcer);

/** The same, or slab by slab. */
LoadedVoxels LoadVoxels(const std::string& name, const std::string& array,
  const VolumeChoice& choice, vtkDeformableSurface* filter, vtkImagePyramid* holder,
  const Announcer& announcer);

// ---- What else a surface is made of -------------------------------------------------------------

class Announcer;
struct ToolOptions;

/** All files that a run reads. */
std::vector<std::string> InputsOf(const ToolOptions& options);

/**
 * Give the filter the start and the attracting points of the command line: positions, which are
 * properties, and what is in files.
 */
void SetStart(const ToolOptions& options, vtkDeformableSurface* filter);

/**
 * Hand the map of edges to the filter, as a second array of the volume.
 * @param holder as LoadVolume has one
 */
void SetEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer);
}

#endif

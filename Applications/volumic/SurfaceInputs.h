// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceInputs_h
#define volumicSurfaceInputs_h

#include <string>
#include <vector>

class vtkDeformableSurface;
class vtkImageData;
class vtkImagePyramid;

namespace tool
{
class Announcer;
class Ranks;
struct ToolOptions;

/** All files that a run reads. */
std::vector<std::string> InputsOf(const ToolOptions& options);

/**
 * All ranks find the same files: by their names and sizes, also where the first alone reads them.
 * @throws Failure on all ranks, which names the rank and the file.
 */
void CheckInputsOnAll(const ToolOptions& options, Ranks& ranks);

/**
 * Give the filter the start and the attracting points of the command line: positions, which are
 * properties, and what is in files, of which one rank reads and has all.
 */
void SetStart(const ToolOptions& options, vtkDeformableSurface* filter, Ranks& ranks);

/**
 * Hand the map of edges to the filter, as a second array of the volume.
 * @param volume the whole; with many ranks it is there on the first, and null elsewhere
 * @param holder as LoadVolume has one
 */
void SetEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer, Ranks& ranks);
}

#endif

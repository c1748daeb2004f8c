// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolLabelMap_h
#define volumicToolLabelMap_h

#include "VolumePart.h"

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

/** A volume of labels. */
struct LabelMap
{
  vtkSmartPointer<vtkImageData> Image; ///< as it was read, with the names of its labels
  /** One label per voxel, active scalars of points or cells: the image, or its components. */
  std::vector<vtkSmartPointer<vtkImageData>> Layers;
  bool IsOfCells = false; ///< where the labels are
  VolumeFacts Facts;
};

/**
 * Read the volume of the command line as labels, and tell what it is. Where voxels have several
 * components, that of --component is taken; or, if the file names labels of each (.seg.nrrd), all.
 * @param settings memory limit, scratch directory and component are taken of it
 * @param holder   as LoadVolume
 * @throws Failure as LoadVolume, and where nothing tells which component is meant.
 */
LabelMap LoadLabelMap(const ToolOptions& options, vtkDeformableSurface* settings,
  vtkImagePyramid* holder, const Announcer& announcer);

/**
 * Give the image the names of its labels, if there are any: those of --label-names, beside its own
 * or those within the file; or else those of a file beside the volume, which is told with --labels
 * only.
 * @throws Failure if the file of --label-names cannot be read.
 */
void NameLabels(const ToolOptions& options, vtkImageData* image, const Announcer& announcer);
}

#endif

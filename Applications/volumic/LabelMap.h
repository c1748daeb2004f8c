// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicToolLabelMap_h
#define volumicToolLabelMap_h

#include "LabelNames.h"
#include "VolumeFacts.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

class vtkDeformableSurface;
class vtkImageData;
class vtkImagePyramid;
class vtkTable;

namespace tool
{
/** A label that the volume has. */
struct KnownLabel
{
  int Label = 0;
  std::string Name; ///< `Label 3` where it has none
  vtkIdType Voxels = 0;
  Vector3 Color = { 0.0, 0.0, 0.0 }; ///< 0 to 1
  int Layer = 0;                     ///< the image, of those of the map, that has it
  /** Indices of the first and last voxels along the three axes, as an extent of VTK. */
  std::array<int, 6> Box = { 0, -1, 0, -1, 0, -1 };
};

/** The rows of a vtkLabelTable. */
std::vector<KnownLabel> LabelsOf(vtkTable* table, int layer);

/**
 * Find the labels that texts of --labels ask for: `all`, numbers, ranges as 7-9 and names, in which
 * * stands for any text, with commas between. The background is one of them only by its number or
 * whole name.
 * @return their places among `known`, ascending
 * @throws Failure that tells those that there are, if a text asks for none of them; `all` may.
 */
std::vector<std::size_t> ChooseLabels(
  const std::vector<std::string>& texts, const std::vector<KnownLabel>& known, int background);

/** The labels of texts that have but numbers, if all do; none otherwise. */
std::vector<KnownLabel> NumberedLabels(
  const std::vector<std::string>& texts, const LabelNames& names);

/**
 * For each label a name of a file without suffix: its name, with other signs in the place of those
 * that file systems don't take, or label-3; no two the same, whatever the case of letters.
 */
std::vector<std::string> FileNamesOf(const std::vector<KnownLabel>& known);

// ---- Which volume -------------------------------------------------------------------------------

class Announcer;
struct ToolOptions;

/** A volume of labels. */
struct LabelMap
{
  vtkSmartPointer<vtkImageData> Image; ///< as it was read, with the names of its labels
  /** One label per voxel, active scalars of the points: the image, or its components. */
  std::vector<vtkSmartPointer<vtkImageData>> Layers;
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

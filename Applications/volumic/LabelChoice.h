// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelChoice_h
#define volumicLabelChoice_h

#include "LabelNames.h"

#include <vtkType.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

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
std::vector<std::size_t> ChooseLabels(const std::vector<std::string>& texts,
  const std::vector<KnownLabel>& known, int background);

/** The labels of texts that have but numbers, if all do; none otherwise. */
std::vector<KnownLabel> NumberedLabels(
  const std::vector<std::string>& texts, const LabelNames& names);

/**
 * For each label a name of a file without suffix: its name, with other signs in the place of those
 * that file systems don't take, or label-3; no two the same, whatever the case of letters.
 */
std::vector<std::string> FileNamesOf(const std::vector<KnownLabel>& known);
}

#endif

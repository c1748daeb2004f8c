// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelBlocks_h
#define volumicLabelBlocks_h

#include "Labels/LabelImage.h"
#include "Labels/LabelInterfaces.h"
#include "Labels/LabelNames.h"
#include "Labels/LabelSettings.h"

#include <cstddef>
#include <string>
#include <vector>

class vtkMultiBlockDataSet;

namespace volumic
{
/** The labels that get surfaces, with their names. */
struct LabelChoice
{
  std::vector<int> Labels; ///< sorted
  bool IsMerged = false;   ///< one surface around all
  LabelNames Names;

  std::vector<int> LabelsOf(std::size_t surface) const
  {
    return this->IsMerged ? this->Labels : std::vector<int>{ this->Labels[surface] };
  }
  std::vector<int> FirstLabels() const
  {
    return this->IsMerged ? std::vector<int>{ this->Labels.front() } : this->Labels;
  }
  std::vector<std::string> BlockNames() const
  {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < this->FirstLabels().size(); ++i)
    {
      names.push_back(this->Names.NameOf(this->LabelsOf(i)));
    }
    return names;
  }
};

/**
 * Make a block for each surface, with the arrays of labels.
 * @param stopped `StopReason` of unfinished surfaces
 * @return a warning about labels that are not represented well (`LostLabels`), or an empty string
 */
std::string FillBlocks(const LabelChoice& choice, const LabelImage& image,
  const LabelSettings& settings, const std::vector<LabelSurface>& surfaces,
  vtkMultiBlockDataSet* output, const std::string& stopped);

/** Add field data with the values, names, colors and voxels of all labels. */
void AddLabelFields(const LabelChoice& choice, const LabelImage& image, vtkPolyData* surface);
}

#endif

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
/** Of which labels there are surfaces, and what they are called. */
struct LabelChoice
{
  std::vector<int> Labels; ///< sorted
  bool IsMerged = false;   ///< one surface about all
  LabelNames Names;

  /** The labels of a surface. */
  std::vector<int> LabelsOf(std::size_t surface) const
  {
    return this->IsMerged ? this->Labels : std::vector<int>{ this->Labels[surface] };
  }
  /** The first label of each surface. */
  std::vector<int> FirstLabels() const
  {
    return this->IsMerged ? std::vector<int>{ this->Labels.front() } : this->Labels;
  }
  /** The name of each surface's block. */
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
 * Makes a block of each surface, with the arrays of labels.
 * @param stopped the `StopReason` of what is not finished
 * @return a warning: labels that have no surface, lose most of their voxels, or have another
 * volume, and what may help; empty: none
 */
std::string FillBlocks(const LabelChoice& choice, const LabelImage& image,
  const LabelSettings& settings, const std::vector<LabelSurface>& surfaces,
  vtkMultiBlockDataSet* output, const std::string& stopped);

/** Names, colours and voxels of all labels, for a surface that has them all. */
void AddLabelFields(const LabelChoice& choice, const LabelImage& image, vtkPolyData* surface);
}

#endif

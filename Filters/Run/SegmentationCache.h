// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationCache_h
#define volumicSegmentationCache_h

#include "Run/SurfaceSegmentation.h"

#include <vtkType.h>

#include <memory>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace volumic
{
/**
 * The last run of a filter, for one that differs from it by where it ends: it has the levels at rest,
 * to show any of them at once, and can go on where it has ended above level 0. At level 0 it holds
 * no more than these, as the rest takes the memory of the whole volume.
 */
class SegmentationCache
{
public:
  /** Whether a run of this filter may be kept: not where data are released. */
  static bool MayKeep(vtkAlgorithm* filter);

  /** It is valid until the filter, or one of its inputs, is modified. */
  void Keep(std::unique_ptr<SurfaceSegmentation> run, vtkAlgorithm* filter);
  void Drop();
  /** Null: none is kept. */
  SurfaceSegmentation* Run() const { return this->Kept.get(); }
  /** It is kept no longer. */
  std::unique_ptr<SurfaceSegmentation> TakeRun();

  /** The filter was modified, from one MTime to another, by what does not matter to the run. */
  void IgnoreChange(vtkMTimeType before, vtkMTimeType after);

  /** Whether neither the filter nor its inputs have changed otherwise. */
  bool IsValidFor(vtkAlgorithm* filter) const;

private:
  /** What comes to a filter, and when it was changed last. */
  using Inputs = std::vector<std::pair<vtkDataObject*, vtkMTimeType>>;
  static Inputs InputsOf(vtkAlgorithm* filter);

  std::unique_ptr<SurfaceSegmentation> Kept;
  vtkMTimeType Time = 0; ///< 0: nothing is kept
  Inputs InputsOfRun;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationCache_h
#define volumicSegmentationCache_h

#include "Output/SegmentationResults.h"
#include "Run/SurfaceSegmentation.h"
#include "Settings/SegmentationSettings.h"

#include <vtkType.h>

#include <memory>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace volumic
{
/**
 * What a filter keeps of its last run, for one that differs from it by where it ends: the levels at
 * rest, to show any of them at once, and, where the run has ended above level 0, the run itself, to
 * go on. That of level 0 is not held, as it takes the memory of the whole volume.
 */
class SegmentationCache
{
public:
  SegmentationCache();
  ~SegmentationCache();

  /** Whether a run of this filter may be kept: not where data are released. */
  static bool MayKeep(vtkAlgorithm* filter);

  /**
   * It is valid until the filter, or one of its inputs, is modified.
   * @param run null on ranks whose results another one has; these ask for IsValidFor() only
   */
  void Keep(std::unique_ptr<SurfaceSegmentation> run, vtkAlgorithm* filter, int ranks);
  void Drop();

  /** The filter was modified, from one MTime to another, by what does not matter to the run. */
  void IgnoreChange(vtkMTimeType before, vtkMTimeType after);

  /** Whether neither the filter nor its inputs have changed otherwise, nor the number of ranks. */
  bool IsValidFor(vtkAlgorithm* filter, int ranks) const;

  /**
   * The results of a run that would end and put out as asked, null where there are none.
   * @throws as SegmentationResults::Choose()
   */
  const SegmentationResults* ResultsFor(
    const SegmentationSettings& settings, const SegmentationRequest& request);
  /** The level at which such a run ends. */
  int EndOf(const SegmentationEnd& end) const;
  /** Whether a run is kept that can go on. */
  bool CanGoOn() const { return this->Run != nullptr; }
  /** The one after the level at which it has ended, or, where it was stopped before, that level. */
  int NextLevel() const;
  /** Whether the run that is kept grades no level, or just the one at which another is to end. */
  bool GradesFor(const SegmentationEnd& end) const
  {
    return !this->IsGraded || end.FinestLevel == this->PlannedEnd;
  }
  /** The run, where it can go on from what it has; else null. It is kept no longer. */
  std::unique_ptr<SurfaceSegmentation> TakeRun();

  /** What comes to a filter, and when it was changed last. */
  using Inputs = std::vector<std::pair<vtkDataObject*, vtkMTimeType>>;
  static Inputs InputsOf(vtkAlgorithm* filter);

private:
  std::unique_ptr<SurfaceSegmentation> Run;
  std::unique_ptr<SegmentationResults> Results; ///< Those of Run where there is one.
  vtkMTimeType Time = 0; ///< 0: nothing is kept
  int Ranks = 1;
  Inputs InputsOfRun;
  bool EndIsPlanned = false;
  bool IsGraded = false;
  int PlannedEnd = 0;
};
}

#endif

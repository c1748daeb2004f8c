// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SegmentationCache_h
#define SegmentationCache_h

#include "SegmentationResults.h"
#include "SurfaceSegmentation.h"

#include <vtkType.h>

#include <memory>
#include <utility>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

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

  /// @param time  of the filter: what is kept serves until another change is told of by it
  /// @param input of the filter: their data must be the same
  void Keep(std::unique_ptr<SurfaceSegmentation> run, vtkMTimeType time,
    vtkInformationVector** input, int ports);
  void Drop();

  /// A change of the filter that does not matter to what is kept: from one time to another.
  void Allow(vtkMTimeType before, vtkMTimeType after);

  /// Whether what is kept is of these inputs and of a filter that has not changed otherwise.
  bool Serves(vtkMTimeType time, vtkInformationVector** input, int ports) const;

  /// The results of a run that would end where asked, null where there are none.
  const SegmentationResults* ResultsFor(const SegmentationRequest& request) const;
  /// The level at which it ends.
  int EndOf(const SegmentationRequest& request) const;
  /// The run, where it can go on from what it has; else null. It is kept no longer.
  std::unique_ptr<SurfaceSegmentation> TakeRun();

  bool HasRecovery() const { return this->Recovery; }

private:
  /// Data are the same if they have the same arrays, unchanged, and lie in the same place: ParaView
  /// hands on other objects with the arrays of those before.
  struct Inputs
  {
    std::vector<std::pair<const void*, vtkMTimeType>> Parts;
    std::vector<double> Places;

    bool operator==(const Inputs& other) const
    {
      return this->Parts == other.Parts && this->Places == other.Places;
    }
  };
  static void Add(vtkDataObject* data, Inputs& inputs);
  static Inputs Describe(vtkInformationVector** input, int ports);

  std::unique_ptr<SurfaceSegmentation> Run;
  std::unique_ptr<SegmentationResults> Results; ///< Those of Run where there is one.
  vtkMTimeType Time = 0; ///< 0: nothing is kept
  Inputs Given;
  bool EndIsPlanned = false;
  int PlannedEnd = 0;
  bool Recovery = false;
};
}

#endif

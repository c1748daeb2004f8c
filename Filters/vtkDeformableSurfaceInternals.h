// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDeformableSurfaceInternals_h
#define vtkDeformableSurfaceInternals_h

#include "Host/RunObserver.h"
#include "Run/InputTimes.h"
#include "Run/SegmentationRun.h"
#include "Settings/SegmentationSettings.h"
#include "vtkDeformableSurface.h"

#include <memory>
#include <string>
#include <vector>

/**
 * What vtkDeformableSurface holds, beside what all algorithms do, and what RequestData() does.
 * All is called on the thread that updates the filter. Errors are thrown, std::invalid_argument
 * where something given is wrong.
 *
 * The last run is kept for one that differs from it by where it ends: it has the levels at rest, to
 * show any of them at once, and can go on where it has ended above level 0. At level 0 it holds no
 * more than these, as the rest takes the memory of the whole volume.
 */
class vtkDeformableSurface::vtkInternals
{
public:
  explicit vtkInternals(vtkDeformableSurface& filter) : Filter(filter) {}

  /**
   * Shows what is kept, or goes on with the last run, or makes another one, until it is over or told
   * to stop; fills the outputs.
   */
  void Update(vtkInformationVector** inputs, vtkInformationVector* outputs,
    volumic::RunObserver& observer);

  /**
   * Makes null blocks of the levels of a run, as far as the pipeline's information of the image, or
   * the number of the pyramid's blocks, tells them.
   */
  void MakeEmptyLevels(vtkInformationVector* input, vtkMultiBlockDataSet* levels) const;

  /** The filter has changed. @param needsRun whether what is kept of the last run serves no more */
  void Modify(bool needsRun);
  void ForgetRun() { this->Kept.reset(); }

  volumic::SegmentationSettings Settings; ///< the properties
  std::unique_ptr<volumic::SegmentationRun> Kept; ///< the last run; null: none
  std::vector<std::string> Warnings; ///< to be told once nothing is on the way
  int MemoryLimit = 0; ///< The three deprecated properties.
  bool Resume = false;
  bool Profile = false;
  bool HasHinted = false;    ///< at labels, as is done once in the filter's life
  bool IsRunning = false;
  bool IsAlone = true;       ///< No other process asks whether a finer level is still to come.
  bool IsWatched = false;    ///< Someone asks whether a finer level is still to come.
  bool IsOnTheWay = false;   ///< One is, and nobody has asked yet.
  bool GoesToTheEnd = false; ///< The next run shows no level before.

private:
  volumic::SegmentationRequest RequestAsSet(vtkInformationVector** inputs);
  /** With ShowLevels: makes it a request for the next level to be shown, if it is not the last. */
  void ChooseStep(volumic::SegmentationRequest& request);
  /** Makes the levels, and of them a run that has not begun. Null where that was stopped. */
  std::unique_ptr<volumic::SegmentationRun> NewRun(
    volumic::SegmentationRequest request, volumic::RunObserver& observer);

  vtkDeformableSurface& Filter;
  vtkMTimeType TimeOfKept = 0; ///< the filter's
  volumic::InputTimes InputsOfKept;
};

#endif

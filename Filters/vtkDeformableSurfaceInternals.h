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
 * The members of vtkDeformableSurface and the work of RequestData(). Call all methods on the thread
 * that updates the filter. Errors are exceptions, a Refusal for invalid input.
 *
 * The filter keeps its last run for requests that differ in the finest level or the outputs only.
 * The run returns any of its converged levels at once, and resumes if it has ended above level 0.
 * On level 0 it keeps these levels only, because the voxels take too much memory.
 */
class vtkDeformableSurface::vtkInternals
{
public:
  explicit vtkInternals(vtkDeformableSurface& filter) : Filter(filter) {}

  /** Reuse, resume or replace the kept run, and fill the outputs. */
  void Update(
    vtkInformationVector** inputs, vtkInformationVector* outputs, volumic::RunObserver& observer);

  /**
   * Makes null blocks of the levels of a run, as far as the pipeline's information of the image, or
   * the number of the pyramid's blocks, tells them.
   */
  void MakeEmptyLevels(vtkInformationVector* input, vtkMultiBlockDataSet* levels) const;

  /** Call Modified() of the filter. @param needsRun whether the kept run becomes invalid */
  void Modify(bool needsRun);
  void ForgetRun() { this->Kept.reset(); }

  volumic::SegmentationSettings Settings;         ///< the properties
  std::unique_ptr<volumic::SegmentationRun> Kept; ///< the last run; null: none
  std::vector<std::string> Warnings;              ///< to report after the last of several steps
  int MemoryLimit = 0;                            ///< deprecated, as the next two
  bool Resume = false;
  bool Profile = false;
  bool HasHinted = false; ///< The hint at labels is reported once per filter.
  bool IsRunning = false;
  bool IsAlone = true;          ///< The run is not parallel.
  bool IsWatched = false;       ///< GetNeedsUpdate() is called, as by ParaView's window.
  bool IsBetweenLevels = false; ///< A finer level follows at the next Update().
  bool RunsToTheEnd = false;    ///< The next run has no intermediate steps.

private:
  volumic::SegmentationRequest RequestAsSet(vtkInformationVector** inputs);
  /** With ShowLevels: end the request at the next intermediate level. */
  void ChooseStep(volumic::SegmentationRequest& request);
  /** Read the volume and return a run that has not begun. Return null if this was stopped. */
  std::unique_ptr<volumic::SegmentationRun> NewRun(
    volumic::SegmentationRequest request, volumic::RunObserver& observer);

  vtkDeformableSurface& Filter;
  vtkMTimeType TimeOfKept = 0; ///< the filter's
  volumic::InputTimes InputsOfKept;
};

#endif

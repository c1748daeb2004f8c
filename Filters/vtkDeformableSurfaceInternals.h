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
 * Members of vtkDeformableSurface, and the work of RequestData(). Call all methods on the thread
 * that updates the filter. They throw an exception on error, InvalidArgument for invalid input.
 *
 * The filter keeps its last run for requests that differ only in the finest level or in the
 * outputs. The kept run returns any of its converged levels at once. It resumes if it has ended
 * above level 0. After level 0 it keeps the levels only, as the voxels take too much memory.
 */
class vtkDeformableSurface::vtkInternals
{
public:
  explicit vtkInternals(vtkDeformableSurface& filter) : Filter(filter) {}

  /** Reuse, resume or replace the kept run, and fill the outputs. */
  void Update(
    vtkInformationVector** inputs, vtkInformationVector* outputs, volumic::RunObserver& observer);

  /**
   * Make null blocks for the levels of a run, from the pipeline information of the image or from
   * the number of blocks of the pyramid.
   */
  void MakeEmptyLevels(vtkInformationVector* input, vtkMultiBlockDataSet* levels) const;

  /** Call Modified() of the filter. @param needsRun whether the kept run becomes invalid */
  void Modify(bool needsRun);
  void ForgetRun() { this->Kept.reset(); }

  volumic::SegmentationSettings Settings;         ///< the properties
  std::unique_ptr<volumic::SegmentationRun> Kept; ///< the last run; null: none
  std::vector<std::string> Warnings;              ///< to report after the last of several steps
  int MemoryLimit = 0;                            ///< deprecated, like the next two
  bool Resume = false;
  bool Profile = false;
  bool HasHinted = false; ///< The hint at labels is reported only once.
  bool IsRunning = false;
  bool IsAlone = true;          ///< The run is not parallel.
  bool IsWatched = false;       ///< GetNeedsUpdate() is called, as by ParaView's window.
  bool IsBetweenLevels = false; ///< A finer level follows at the next Update().
  bool RunsToTheEnd = false;    ///< The next run has no intermediate steps.

private:
  volumic::SegmentationRequest MakeRequest(vtkInformationVector** inputs);
  /** With ShowLevels: end the request at the next intermediate level. */
  void ChooseStep(volumic::SegmentationRequest& request);
  /** Read the volume and return a new run. Return null if reading was stopped. */
  std::unique_ptr<volumic::SegmentationRun> NewRun(
    volumic::SegmentationRequest request, volumic::RunObserver& observer);

  vtkDeformableSurface& Filter;
  vtkMTimeType TimeOfKept = 0; ///< modification time of the filter for the kept run
  volumic::InputTimes InputsOfKept;
};

#endif

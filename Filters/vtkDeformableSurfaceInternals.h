// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDeformableSurfaceInternals_h
#define vtkDeformableSurfaceInternals_h

#include "Host/Deadline.h"
#include "Host/LimitedMemory.h"
#include "Ranks/Ranks.h"
#include "Run/SegmentationCache.h"
#include "Run/SegmentationCheckpoint.h"
#include "Settings/SegmentationSettings.h"
#include "Settings/SegmentationVolume.h"
#include "vtkDeformableSurface.h"

#include <vtkMultiProcessController.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

namespace volumic
{
struct SegmentationRequest;
class SurfaceSegmentation;
}

/**
 * What vtkDeformableSurface holds, beside what all algorithms do, and what RequestData() does.
 * All is called on the thread that updates the filter. Errors are thrown, std::invalid_argument
 * where something given is wrong.
 */
class vtkDeformableSurface::vtkInternals
{
public:
  explicit vtkInternals(vtkDeformableSurface& filter) : Filter(filter) {}

  /**
   * At the first rank, once All is set: shows what is kept, or goes on with the last run, or makes
   * another one, until it is over or told to stop. Afterwards the outputs are filled, and the run
   * is kept.
   */
  void RunOrGoOn(const volumic::FilterCall& call);

  volumic::SegmentationSettings Settings; ///< the properties
  volumic::LimitedMemory Memory;          ///< as the last run had it; outlives what is kept
  volumic::SegmentationCache Cache;       ///< of the last run
  volumic::Deadline Limit;                ///< of the run
  std::shared_ptr<volumic::SegmentationCheckpoint> Checkpoint; ///< of the last run; null: none
  vtkSmartPointer<vtkMultiProcessController> Controller;
  std::unique_ptr<volumic::Ranks> All; ///< of the run that is under way; else null
  vtkSmartPointer<vtkPolyData> InitialSurface;   ///< of the run, of all ranks
  vtkSmartPointer<vtkPolyData> AttractingPoints; ///< likewise
  std::vector<std::string> Warnings; ///< to be told at the end
  bool LeavesCheckpoints = false; ///< also of runs that have come to their end
  bool HasToldOfWhole = false; ///< that the image does not come in slabs
  bool IsWatched = false;    ///< Someone asks whether a finer level is still to come.
  bool IsOnTheWay = false;   ///< One is, and nobody has asked yet.
  bool GoesToTheEnd = false; ///< The next run shows no level before.

private:
  /** What becomes of the last run. */
  enum class Course
  {
    IsShown, ///< It has all that is asked for: the outputs are filled.
    GoesOn,
    BeginsAnew ///< It is gone; another one is to be made.
  };
  /**
   * What a run is asked for by the properties and the inputs. From now on the run's time counts.
   */
  volumic::SegmentationRequest RequestAsSet(const volumic::FilterCall& call);
  /** With ShowLevels: makes it a request for the next level to be shown, if it is not the last. */
  void ChooseStep(volumic::SegmentationRequest& request, bool isKept);
  /** Fills the outputs with what is kept. @return whether it is all that is wanted */
  bool ShowKept(const volumic::SegmentationRequest& request, vtkInformationVector* output);
  /** Makes the levels, and of them a run that has not begun. Null where that was stopped. */
  std::unique_ptr<volumic::SurfaceSegmentation> NewRun(
    const volumic::SegmentationRequest& request, const volumic::FilterCall& call);
  /** Afterwards only what is shown is kept. @param run gets the one that goes on */
  Course ChooseCourse(bool isKept, volumic::SegmentationRequest& request,
    std::unique_ptr<volumic::SurfaceSegmentation>& run, vtkInformationVector* output);
  /** Fills the outputs with what a run has, that is over or was stopped. */
  void ShowRun(const volumic::SurfaceSegmentation& run,
    const volumic::SegmentationRequest& request, vtkInformationVector* output);
  /** Whether this rank or another one was asked to stop. */
  bool IsStopped();

  vtkDeformableSurface& Filter;
};

#endif

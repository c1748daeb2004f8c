// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDeformableSurfaceInternals_h
#define vtkDeformableSurfaceInternals_h

#include "Run/SegmentationCache.h"
#include "Settings/SegmentationSettings.h"
#include "vtkDeformableSurface.h"


#include <memory>
#include <set>
#include <string>
#include <vector>

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
   * Shows what is kept, or goes on with the last run, or makes another one, until it is over or told
   * to stop. Afterwards the outputs are filled, and the run is kept.
   */
  void RunOrGoOn(vtkInformationVector** inputs, vtkInformationVector* outputs);
  /** Told at the end of the run, once: ParaView's message box would cover the progress bar. */
  void Warn(const std::string& text);

  volumic::SegmentationSettings Settings; ///< the properties
  volumic::SegmentationCache Cache;       ///< of the last run
  bool IsRunning = false;
  bool IsOnlyProcess = true; ///< in the run that is under way
  std::vector<std::string> Warnings;   ///< to be told at the end
  std::set<std::string> WarnedOf;      ///< what is told once in the filter's life
  int MemoryLimit = 0;                 ///< has no effect
  bool Resume = false;                 ///< has no effect
  bool IsWatched = false;    ///< Someone asks whether a finer level is still to come.
  bool IsOnTheWay = false;   ///< One is, and nobody has asked yet.
  bool GoesToTheEnd = false; ///< The next run shows no level before.

private:
  /**
   * What a run is asked for by the properties and the inputs. From now on the run's time counts.
   */
  volumic::SegmentationRequest RequestAsSet(vtkInformationVector** inputs);
  /**
   * With ShowLevels: makes it a request for the next level to be shown, if it is not the last.
   * @param kept may be null
   */
  void ChooseStep(
    volumic::SegmentationRequest& request, const volumic::SurfaceSegmentation* kept);
  /** Makes the levels, and of them a run that has not begun. Null where that was stopped. */
  std::unique_ptr<volumic::SurfaceSegmentation> NewRun(
    volumic::SegmentationRequest request, vtkInformationVector* input);
  /** Returns whether to continue. */
  bool ShowProgress(double share, const std::string& text);

  vtkDeformableSurface& Filter;
};

#endif

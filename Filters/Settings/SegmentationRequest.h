// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationRequest_h
#define volumicSegmentationRequest_h

#include "Host/Deadline.h"
#include "Host/ProgressMonitor.h"
#include "Settings/SegmentationSettings.h"

#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <memory>
#include <string>

namespace volumic
{
class SegmentationCheckpoint;
struct SurfaceResult;

/** What a run is asked for: settings, inputs, and whom it tells. */
struct SegmentationRequest
{
  /** As set, but for what was found for the image, and where a step on the way ends. */
  SegmentationSettings Settings;

  vtkSmartPointer<vtkMultiBlockDataSet> Levels; ///< null where their making was stopped
  vtkSmartPointer<vtkInformation> Selection; ///< of the voxels, as GetInputArrayInformation()
  double FactorBelowLevel0 = 1.7320508075688772; ///< U_0 over the unit of level -1
  /** Made for this run, by EdgeLength if there is one; nobody was told of their NaN voxels. */
  bool LevelsAreOwn = false;
  vtkSmartPointer<vtkPolyData> InitialSurface;   ///< input port 1, may be missing
  vtkSmartPointer<vtkPolyData> AttractingPoints; ///< input port 2, may be missing
  vtkInformation* EdgeSelection = nullptr; ///< of the map of edges; without effect at weight 0

  bool IsStep = false;  ///< Another run goes on from it: what is wrong with the surface may change.
  bool MayGoOn = false; ///< After a stop, too: what rests stays while a finer level is under way.
  bool KeepsAll = false; ///< All components stay, for who may choose others.
  bool CheckpointStays = false; ///< It is not removed at the end, whose own is left, too.
  Deadline Limit;
  /** When the run began: what came before counts to the seconds of its first level. */
  Deadline::Clock::time_point Started = Deadline::Clock::now();
  ProgressMonitor::Callback Progress;
  std::function<void(const std::string& text)> Warn;
  /** Given the run's checkpoint, once it has been looked at; null where it has none. */
  std::function<void(const std::shared_ptr<SegmentationCheckpoint>& checkpoint)> Prepared;
  /** See LevelTask::Revise; of the last level, where this is 0 or -1. */
  std::function<bool(const SurfaceResult& surface)> Revise;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationRequest_h
#define volumicSegmentationRequest_h

#include "Host/Deadline.h"
#include "Host/ProgressMonitor.h"
#include "Settings/SegmentationSettings.h"

#include <functional>
#include <memory>
#include <string>

class vtkInformation;
class vtkPolyData;

namespace volumic
{
class SegmentationCheckpoint;
struct SurfaceResult;

/** Whether a run leaves what another process can go on from; see SegmentationCheckpoint. */
struct CheckpointRequest
{
  bool AreLeft = false;  ///< at the end of each level
  std::string Directory; ///< the scratch directory; empty: the system's
  bool Resumes = false;  ///< Go on from one, where there is one.
  bool Stay = false;     ///< They are not removed at the end, whose own is left, too.
  /** Given the run's own, once it has been looked at; null where it has none. */
  std::function<void(const std::shared_ptr<SegmentationCheckpoint>& checkpoint)> Prepared;
};

/**
 * What a run is asked for, beside the settings: where it ends, inputs that may come in other
 * objects for one that goes on, and the callbacks.
 */
struct SegmentationRequest
{
  SegmentationEnd End;  ///< As set, or for a step on the way. With EdgeLength the level is planned.
  bool IsStep = false;  ///< Another run goes on from it: what is wrong with the surface may change.
  bool MayGoOn = false; ///< After a stop, too: what rests stays while a finer level is under way.
  bool KeepsAll = false; ///< All components stay, for who may choose others.
  vtkPolyData* InitialSurface = nullptr;   ///< input port 1, may be missing
  vtkPolyData* AttractingPoints = nullptr; ///< input port 2, may be missing
  vtkInformation* EdgeSelection = nullptr; ///< of the map of edges; without effect at weight 0
  CheckpointRequest Checkpoints;
  Deadline Limit;
  /** When the run began: what came before counts to the seconds of its first level. */
  Deadline::Clock::time_point Started = Deadline::Clock::now();
  ProgressMonitor::Callback Progress;
  std::function<void(const std::string& text)> Warn;
  /**
   * Asked at the end of the last level, which is 0 or -1: whether it has changed some voxels, so
   * that the surface must be revised, and it asked again. Empty: they stay.
   */
  std::function<bool(const SurfaceResult& surface)> Revise;
};
}

#endif

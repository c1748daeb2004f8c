// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationRun_h
#define volumicSegmentationRun_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Image/LevelImage.h"
#include "Host/HostThreads.h"
#include "Host/RunObserver.h"
#include "Output/FinishedLevels.h"
#include "Run/ReadVolume.h"
#include "Run/RunStart.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationSettings.h"

#include <functional>
#include <string>

class vtkInformationVector;

namespace volumic
{
/**
 * The segmentation of a volume from the coarsest level to the finest. Its state is the list of
 * finished levels, which fill the outputs of vtkDeformableSurface. A completed run can be resumed
 * at the next finer level, and a stopped run at the last converged level. The result is the same as
 * without interruption.
 *
 * Call all methods on one thread. The observer is called on this thread, too.
 */
class SegmentationRun
{
public:
  /** @throws InvalidArgument if the volume is not suitable or a setting is out of range */
  SegmentationRun(const SegmentationRequest& request, const Volume& volume);

  /** Return whether the graded level, if any, is the finest level of another request. */
  bool HasGradingOf(const SegmentationRequest& request) const
  {
    return !this->Settings.Grading.IsRequested() ||
      request.Settings.End.FinestLevel == this->Settings.End.FinestLevel;
  }
  /** Return whether the finished levels suffice for another request. */
  bool HasAll(const SegmentationRequest& request) const
  {
    return this->Finished.HasConverged(this->EndOf(request.Settings.End));
  }
  /**
   * Replace the request for the next Run(). With EdgeLength the planned finest level remains.
   * @return false if a new run is necessary, because required voxels or components are released
   * @throws InvalidArgument as ChoiceOf() does
   */
  bool Renew(const SegmentationRequest& request);

  /**
   * Compute the levels down to EndsAt(). A stopped run has its current surface, which may be empty,
   * with its StopReason. Another Run() restarts the unfinished level. Do not use the object after
   * an exception.
   * @param before fraction of the work before this call
   * @throws InvalidArgument if settings and image do not match, std::bad_alloc, ScratchFull
   */
  void Run(RunObserver& observer, double before);

  int EndsAt() const { return this->Choice.Last; }
  /** Return the level after EndsAt() for a completed run, else EndsAt(). */
  int NextLevel() const { return this->HasReachedEnd() ? this->Reached - 1 : this->EndsAt(); }
  /** Return whether Run() can compute a finer level. At level 0 only a stopped run can. */
  bool CanResume() const
  {
    return this->CanContinue && !(this->Reached <= 0 && this->HasReachedEnd());
  }
  /** Release everything but the finished levels, if CanResume() is false. */
  void ReleaseRunData();

  void FillOutputs(vtkInformationVector* outputs) const
  {
    this->Finished.FillOutputs(this->EndsAt(), outputs);
  }
  vtkSmartPointer<vtkPolyData> LeftOut(Executor& threads) const
  {
    return this->Finished.LeftOut(this->EndsAt(), threads);
  }
  std::string Warning(bool warnsOfMissing) const
  {
    return this->Finished.WarningOf(this->EndsAt(), warnsOfMissing && this->Levels.Seeds().empty());
  }

private:
  bool HasReachedEnd() const { return this->Finished.HasConverged(this->EndsAt()); }
  int EndOf(const SegmentationEnd& end) const;
  /** Apply EdgeLength to existing levels: finest level, sampling ratio, factor below level 0. */
  void ChooseEdgeLength();
  /** Select the components of the outputs. @return false if not all components were kept */
  bool ChooseComponents(const SegmentationRequest& request, Executor& threads);
  /** Discard the finished levels. The next one is the coarsest. */
  void Begin();
  /**
   * Compute the next level. If it is stopped, restore the surface of the last level if it was kept.
   * @return false if it was stopped
   */
  bool Next(RunObserver& observer, LevelMonitor& monitor, HostThreads& threads);
  /** Return the task of a level. The image must outlive it. */
  LevelTask TaskOf(int level, const LevelImage& image, HostThreads& threads);
  LevelOutcome Evolve(LevelTask& task, LevelMonitor& monitor, HostThreads& threads);
  /** Keep a snapshot at the end of a sweep, at the intervals of SnapshotInterval. */
  void TakeSnapshot(
    int level, int iteration, const std::function<SurfaceResult()>& take, HostThreads& threads);
  void KeepLevel(int level, LevelOutcome outcome, RunObserver& observer, HostThreads& threads);
  /** Return whether a preview must continue to a finer level because too much is missing. */
  bool PreviewMissesParts(int level) const;

  SegmentationRequest Request; ///< without the volume; SeedRadius in computational space
  SegmentationSettings& Settings = Request.Settings;
  SegmentationLevels Levels;
  LevelChoice Choice;
  bool HasBegun = false;
  FinishedLevels Finished;
  ConvergedSurface Converged; ///< converged surface of level Reached
  int Reached = 0;
  bool CanContinue = false;      ///< A finer level can start from Converged.
  int LastSnapshotIteration = 0; ///< iteration of the last call of TakeSnapshot()
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSegmentation_h
#define volumicSurfaceSegmentation_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Image/LevelImage.h"
#include "Host/HostThreads.h"
#include "Host/ProgressMonitor.h"
#include "Output/SegmentationResults.h"
#include "Run/RunStart.h"
#include "Run/SegmentationCheckpoint.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationSettings.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace volumic
{
/**
 * The run from the coarsest level to the finest: starts, evolves, divides, and keeps what the
 * outputs of vtkDeformableSurface hold. One that has ended at a level can go on from there, as if
 * it had never ended; one that was stopped, from the last level at which the surface rested.
 *
 * One thread calls all of it, and is the one on which the callbacks of the request are called;
 * others work within the loops of HostThreads only.
 */
class SurfaceSegmentation
{
public:
  /** @throws std::invalid_argument if the levels are not a pyramid or a setting is out of range. */
  explicit SurfaceSegmentation(const SegmentationRequest& request);
  ~SurfaceSegmentation();

  /** Whether it grades no level, or just the one at which another request ends. */
  bool GradesFor(const SegmentationRequest& request) const
  {
    return !this->Settings.Grading.IsWanted() ||
      request.Settings.End.FinestLevel == this->Settings.End.FinestLevel;
  }
  /**
   * Whether a run that would end, and put out, as another request asks has nothing to do: then
   * Results() are its, for EndOf() it. @throws as SegmentationResults::Choose()
   */
  bool HasAll(const SegmentationRequest& request);
  /** The level at which such a run ends. */
  int EndOf(const SegmentationRequest& request) const;
  /**
   * For the next Run(), which is to end, and to put out, otherwise; with EdgeLength the finest
   * level stays what was planned.
   * @return whether that can be reached from here: levels that the surface has left are let go, and
   *         a run that would begin at one of them must be made anew
   */
  bool Renew(const SegmentationRequest& request);

  /**
   * Goes on from the level at which the last Run() has ended, or begins, and ends at the level that
   * the request asks for: EndsAt() tells it, Results() have all that were passed.
   * Where Progress asks to stop, or time is over, the surface is what there is then, and marked so;
   * it is empty where there is none yet. Another Run() takes up the level that was under way from
   * its begin. After an exception the object is of no use any more.
   * @throws std::invalid_argument if settings and image do not fit, std::bad_alloc, ScratchFull.
   */
  void Run();

  /** Whether Run() would go on from a level at rest: of the image itself only after a stop. */
  bool CanGoOn() const;
  /** The one after the level at which it has ended, or, where it was stopped before, that level. */
  int NextLevel() const { return this->EndsAt() - (this->Found.HasAtRest(this->EndsAt()) ? 1 : 0); }
  /** Of one that cannot go on: all but the results. */
  void LetGo();

  const SegmentationResults& Results() const { return this->Found; }
  /** The level at which the last Run() was to end. */
  int EndsAt() const { return this->Choice.Last; }

private:
  /** With EdgeLength: plans finest level, sampling ratio and factor below level 0. */
  void ChooseEdgeLength();
  /** Of Found. @return see SegmentationResults::Choose() */
  bool Choose(const SegmentationRequest& request);
  /** Forgets the last run, its results included; the next level is the coarsest one. */
  void Begin();
  /**
   * Before: Choice is made, the results of levels at rest are in Found.
   * Brings the surface level by level to Choice.Last, as long as it is fit to go on and nobody asks
   * to stop. At the end of each pass of the loop the surface lies on level Reached, Found has it,
   * and the history, and a checkpoint of it is left where these are wanted; after a stop it is back
   * where it rested last, if that was kept.
   */
  void RunLevels();
  /** A pass of that loop. @return false where it was stopped */
  bool RunLevel(int level);
  /** What a level is to be; the image must outlive it. */
  LevelTask TaskOf(int level, const LevelImage& image);
  LevelOutcome Evolve(LevelTask& task);
  /** With SnapshotInterval: keeps the surface at the end of the sweep in which one is due. */
  void TakeSnapshot(int level, int iteration, const std::function<SurfaceResult()>& take);
  /** Whether a preview that has come to this level must go on, as too much is missing. */
  bool PreviewMissesParts(int level) const;
  /** Puts the surface of a level into Found. @return whether it is fit for a finer level */
  bool KeepLevel(int level, LevelOutcome outcome);
  /** Once a Run(), before RunLevels(): finds out of which run a checkpoint would be. */
  void PrepareCheckpoint();
  /** Once a run, before its first level: goes on from a checkpoint, where that is asked for. */
  void Resume();
  /** After KeepLevel(), where checkpoints are left: what cannot be written is a warning. */
  void LeaveCheckpoint(int level);
  /**
   * Where a run was stopped before it came to a level: what it shows is the surface of the last.
   */
  void KeepStoppedSurface(int level);
  std::string DescribeStop() const;

  SegmentationRequest Request; ///< Without the levels; SeedRadius in the workspace.
  SegmentationSettings& Settings = Request.Settings;
  SegmentationLevels Levels;
  LevelChoice Choice;
  SegmentationResults Found;
  std::optional<HostThreads> Threads; ///< these two within Run()
  std::optional<ProgressMonitor> Progress;
  bool HasBegun = false;
  SurfaceAtRest Rest; ///< at level Reached
  int Reached = 0;
  bool GoesOn = false;  ///< It rests there, and is fit for a finer level.
  int SnapshotLook = 0; ///< Iteration of the level at which the last snapshot could be taken.
  std::shared_ptr<SegmentationCheckpoint> Left; ///< null: none is left
};
}

#endif

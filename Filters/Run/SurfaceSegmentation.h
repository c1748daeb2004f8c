// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSegmentation_h
#define volumicSurfaceSegmentation_h

#include "Core/Common/IndexedSurface.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Image/LevelImage.h"
#include "Host/HostThreads.h"
#include "Host/ProgressMonitor.h"
#include "Output/SegmentationResults.h"
#include "Output/SurfaceSnapshots.h"
#include "Run/EvolutionAtRest.h"
#include "Run/LevelChoice.h"
#include "Run/SegmentationCheckpoint.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationRequest.h"
#include "Settings/SegmentationSettings.h"
#include "Settings/SegmentationVolume.h"

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
 * One thread calls all of it, and is the one on which Progress, Warn, Prepared and Revise of the
 * request are called; others work within the loops of HostThreads only.
 */
class SurfaceSegmentation
{
public:
  /** @throws std::invalid_argument if the levels are not a pyramid or a setting is out of range. */
  SurfaceSegmentation(const SegmentationVolume& volume, const SegmentationRequest& request);
  ~SurfaceSegmentation();

  /**
   * For the next Run(). With EdgeLength the finest level stays what was planned.
   * @throws as SegmentationResults::Choose()
   */
  void Renew(const SegmentationRequest& request);

  /** SegmentationResults::Choose() of what a run has found. */
  static bool Choose(SegmentationResults& results, const SegmentationSettings& settings,
    const SegmentationRequest& request);

  /**
   * After Renew(): whether what is wanted can be reached from here. Levels that the surface has left
   * are let go; a run that would begin at one of them must be made anew.
   * @throws as Run().
   */
  bool CanServe() const;

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

  const SegmentationSettings& GetSettings() const { return this->Settings; }
  const SegmentationResults& Results() const { return this->Found; }
  SegmentationResults& Results() { return this->Found; }
  /** The level at which the last Run() was to end. */
  int EndsAt() const { return this->Choice.Last; }

private:
  void CheckGrading() const;
  /** With EdgeLength: plans finest level, sampling ratio and factor below level 0, if need be. */
  void ChooseEdgeLength(const SegmentationVolume& volume);
  /**
   * On the coarsest level: gives the evolution its surface. @throws as SurfaceEvolution's starts
   */
  void Start(SurfaceEvolution& evolution, const LevelImage& image);
  /** Forgets the last run, its results included; the next level is the coarsest one. */
  void Begin();
  /**
   * Within HostThreads::Run. Before: Choice is made, the results of levels at rest are in Found.
   * Brings the surface level by level to Choice.Last, as long as it is fit to go on and nobody asks
   * to stop. At the end of each pass of the loop the surface lies on level Reached, Found has it,
   * and a checkpoint of it is left where these are wanted. Afterwards Found has the history; after
   * a stop the evolution is back where it rested last (ReturnToRest).
   */
  void RunLevels();
  void MakeEvolution();
  /** After a stop: makes the evolution again of Rest. Empties Rest in any case. */
  void ReturnToRest();
  /** Whether a preview that has come to this level must go on, as too much is missing. */
  bool PreviewMissesParts(int level) const;
  /** In the workspace; 0: as it comes. */
  double WantedMeanEdge(int level) const;
  /**
   * Brings the surface to a level, by a start or a division, and evolves it there.
   * @return false where it was stopped before it had come there: then it still lies on the level
   *         before, and reason and surface say nothing
   */
  bool EvolveOn(
    const LevelImage& image, int level, StopReason& reason, SurfaceResult& surface);
  /** Puts the surface of a level into Found. @return whether it is fit for a finer level */
  bool KeepLevel(int level, StopReason reason, SurfaceResult surface);
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

  SegmentationSettings Settings; ///< End as asked for; SeedRadius in the workspace
  SegmentationRequest Request;
  SegmentationLevels Levels;
  LevelChoice Choice;
  SurfaceSnapshots Snapshots;
  SegmentationResults Found;
  std::optional<HostThreads> Threads;
  std::optional<ProgressMonitor> Progress;
  std::unique_ptr<SurfaceEvolution> Evolution; ///< of the last two; null before the first run
  int Reached = 0;     ///< the level at which it rests
  bool GoesOn = false; ///< It does, and is fit for a finer one.
  EvolutionAtRest Rest; ///< The evolution as it rested there, while it is at a finer one.
  bool HasChosen = true; ///< The components of what is there are those that are wanted.
  std::shared_ptr<SegmentationCheckpoint> Left; ///< null: none is left
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSegmentation_h
#define volumicSurfaceSegmentation_h

#include "Core/Common/CheckedFile.h"
#include "Core/Common/IndexedSurface.h"
#include "Core/Common/MeasuredExecutor.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Image/LevelImage.h"
#include "Host/HostThreads.h"
#include "Host/ProgressMonitor.h"
#include "Output/SegmentationResults.h"
#include "Output/SurfaceSnapshots.h"
#include "Run/LevelChoice.h"
#include "Run/SegmentationCheckpoint.h"
#include "Run/SegmentationLevels.h"
#include "Settings/SegmentationRequest.h"
#include "Settings/SegmentationSettings.h"
#include "Settings/SegmentationVolume.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace volumic
{
class RankLevel;

/**
 * The run from the coarsest level to the finest: starts, evolves, divides, and keeps what the
 * outputs of vtkDeformableSurface hold. One that has ended at a level can go on from there, as if
 * it had never ended; one that was stopped, from the last level at which the surface rested.
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

  /**
   * After Renew(): whether what is wanted can be reached from here. Levels that the surface has left
   * are let go; a run that would begin at one of them must be made anew.
   * @throws as Run().
   */
  bool CanServe() const;

  /**
   * Where Progress asks to stop, or time is over, the surface is what there is then, and marked so;
   * it is empty where there is none yet. Another Run() takes up the level that was under way from
   * its begin.
   * @throws std::invalid_argument if settings and image do not fit.
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
  void ChooseEdgeLength(const SegmentationVolume& volume);
  void Start(SurfaceEvolution& evolution, const LevelImage& image);
  void Begin();
  void RunLevels();
  void MakeEvolution();
  void KeepRest();
  void ReturnToRest();
  /** Whether a preview that has come to this level must go on, as too much is missing. */
  bool PreviewMissesParts(int level) const;
  bool MayBeShared(int level) const;
  void GatherVoxels(int level);
  bool EvolveOn(
    const LevelImage& image, int level, StopReason& reason, SurfaceResult& surface);
  bool KeepLevel(int level, StopReason reason, SurfaceResult surface);
  void PrepareCheckpoint();
  void Resume();
  void LeaveCheckpoint(int level);
  void KeepStoppedSurface(int level);
  std::string DescribeStop() const;

  SegmentationSettings Settings; ///< End as asked for; SeedRadius in the workspace
  SegmentationRequest Request;
  SegmentationLevels Levels;
  LevelChoice Choice;
  SurfaceSnapshots Snapshots;
  SegmentationResults Found;
  std::optional<HostThreads> Threads;
  std::optional<MeasuredExecutor> Measured; ///< The same, for Profile.
  std::optional<ProgressMonitor> Progress;
  std::unique_ptr<SurfaceEvolution> Evolution; ///< of the last two; null before the first run
  int Reached = 0;     ///< the level at which it rests
  bool GoesOn = false; ///< It does, and is fit for a finer one.
  FileInMemory Rest; ///< The evolution as it rested there, while it is at a finer one.
  bool HasChosen = true; ///< The components of what is there are those that are wanted.
  std::shared_ptr<SegmentationCheckpoint> Left;
  std::unique_ptr<RankLevel> Shared; ///< what the evolution refers to, after a level on all ranks
};
}

#endif

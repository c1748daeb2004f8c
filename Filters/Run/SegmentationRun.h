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
 * The run from the coarsest level to the finest: starts, evolves, divides. Its state is the list of
 * levels that it has finished, which give the outputs of vtkDeformableSurface. One that has ended at
 * a level can go on from there, as if it had never ended; one that was stopped, from the last level
 * at which the surface rested.
 *
 * One thread calls all of it, and is the one that tells the observer; others work within the loops
 * of HostThreads only.
 */
class SegmentationRun
{
public:
  /** @throws std::invalid_argument if the volume does not do or a setting is out of range. */
  SegmentationRun(const SegmentationRequest& request, const Volume& volume);

  /** Whether it grades no level, or just the one at which another request ends. */
  bool GradesFor(const SegmentationRequest& request) const
  {
    return !this->Settings.Grading.IsWanted() ||
      request.Settings.End.FinestLevel == this->Settings.End.FinestLevel;
  }
  /** Whether what another one asks for needs no other level. */
  bool HasAll(const SegmentationRequest& request) const
  {
    return this->Finished.HasAtRest(this->EndOf(request.Settings.End));
  }
  /**
   * For the next Run(), which is to end, and to put out, otherwise; with EdgeLength the finest
   * level stays what was planned.
   * @return whether that can be reached from here: of the finest level the image is not kept, and
   *         levels that the surface has left are let go; else the run must be made anew
   * @throws as ChoiceOf()
   */
  bool Renew(const SegmentationRequest& request);

  /**
   * Makes levels until that is there at which it is to end.
   * After a stop the surface is what there is then, and marked so; it is empty where there is none
   * yet. Another Run() takes up the level that was under way from its begin. After an exception the
   * object is of no use any more.
   * @param before share of the work that is done already
   * @throws std::invalid_argument if settings and image do not fit, std::bad_alloc.
   */
  void Run(RunObserver& observer, double before);

  /** The level at which it is to end. */
  int EndsAt() const { return this->Choice.Last; }
  /** The one after the finest at rest; where it was stopped before, the level to end at. */
  int NextLevel() const { return this->HasCome() ? this->Reached - 1 : this->EndsAt(); }
  /** Whether Run() would go on from a level at rest: of the image itself only after a stop. */
  bool CanGoOn() const { return this->GoesOn && !(this->Reached <= 0 && this->HasCome()); }
  /** Of one that cannot go on: all but the finished levels. */
  void LetGo();

  void FillOutputs(vtkInformationVector* outputs) const
  {
    this->Finished.FillOutputs(this->EndsAt(), outputs);
  }
  /** See FinishedLevels::WarningOf(). */
  std::string Warning(bool wantsAll) const
  {
    return this->Finished.WarningOf(this->EndsAt(), wantsAll);
  }

private:
  bool HasCome() const { return this->Finished.HasAtRest(this->EndsAt()); }
  /** The level at which a run ends that is to end so. */
  int EndOf(const SegmentationEnd& end) const;
  /** With EdgeLength, of blocks: plans finest level, sampling ratio and factor below level 0. */
  void ChooseEdgeLength();
  /** Chooses the components that are put out. @return false where those were not all kept */
  bool ChooseComponents(const SegmentationRequest& request);
  /** Forgets the finished levels; the next one is the coarsest. */
  void Begin();
  /**
   * Makes the level after that which the surface rests on. After a stop the surface is back there,
   * if it was kept. @return false where it was stopped
   */
  bool Next(RunObserver& observer, LevelMonitor& monitor, HostThreads& threads);
  /** What a level is to be; the image must outlive it. */
  LevelTask TaskOf(int level, const LevelImage& image, HostThreads& threads);
  LevelOutcome Evolve(LevelTask& task, LevelMonitor& monitor, HostThreads& threads);
  /** With SnapshotInterval: keeps the surface at the end of the sweep in which one is due. */
  void TakeSnapshot(int level, int iteration, const std::function<SurfaceResult()>& take,
    HostThreads& threads);
  void KeepLevel(int level, LevelOutcome outcome, RunObserver& observer, HostThreads& threads);
  /** Whether a preview that has come to this level must go on, as too much is missing. */
  bool PreviewMissesParts(int level) const;

  SegmentationRequest Request; ///< Without the volume; SeedRadius in the workspace.
  SegmentationSettings& Settings = Request.Settings;
  SegmentationLevels Levels;
  LevelChoice Choice;
  bool HasBegun = false;
  FinishedLevels Finished;
  SurfaceAtRest Rest; ///< at level Reached
  int Reached = 0;
  bool GoesOn = false;  ///< It rests there, and is fit for a finer level.
  int SnapshotLook = 0; ///< Iteration of the level at which the last snapshot could be taken.
};
}

#endif

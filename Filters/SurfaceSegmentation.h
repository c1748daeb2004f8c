// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceSegmentation_h
#define volumicSurfaceSegmentation_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Image/PointAttraction.h"
#include "Deadline.h"
#include "EdgeLevels.h"
#include "HostThreads.h"
#include "KeepComponents.h"
#include "ProgressMonitor.h"
#include "PyramidLevels.h"
#include "SegmentationResults.h"
#include "SegmentationSettings.h"
#include "SegmentationVolume.h"
#include "SurfaceSnapshots.h"

#include <vtkSmartPointer.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkInformation;
class vtkMultiBlockDataSet;
class vtkPolyData;

namespace volumic
{
/**
 * What a run is asked for, beside the settings: where it ends, inputs that may come in other objects
 * for one that goes on, and what hears of the work.
 */
struct SegmentationRequest
{
  SegmentationEnd End;  ///< As set, or for a step on the way. With EdgeLength the level is planned.
  bool IsStep = false;  ///< Another run goes on from it: what is wrong with the surface may change.
  vtkPolyData* InitialSurface = nullptr;   ///< input port 1, may be missing
  vtkPolyData* AttractingPoints = nullptr; ///< input port 2, may be missing
  vtkInformation* EdgeSelection = nullptr; ///< of the map of edges; without effect at weight 0
  Deadline Limit;
  /** When the run began: what came before counts to the seconds of its first level. */
  Deadline::Clock::time_point Started = Deadline::Clock::now();
  ProgressMonitor::Tell Progress;
  std::function<void(const std::string& text)> Warn;
};

/**
 * The run from the coarsest level to the finest: starts, evolves, divides, and keeps what the
 * outputs of vtkDeformableSurface hold. One that has ended at a level can go on from there, as if
 * it had never ended.
 */
class SurfaceSegmentation
{
public:
  /// Preview ends at the finest level of at most so many voxels.
  static constexpr int VoxelsOfPreview = 1000000;

  /// @throws std::invalid_argument if the levels are not a pyramid or a setting is out of range.
  SurfaceSegmentation(const SegmentationVolume& volume, const SegmentationRequest& request);
  ~SurfaceSegmentation();

  /// For the next Run(). With EdgeLength the finest level stays what was planned.
  void Renew(const SegmentationRequest& request);

  /// Where Progress asks to stop, or time is over, the surface is what there is then, and marked so;
  /// it is empty where there is none yet.
  /// @throws std::invalid_argument if settings and image do not fit.
  void Run();

  /// Whether Run() would go on from a level at rest that is not the image itself.
  bool CanGoOn() const;

  const SegmentationSettings& GetSettings() const { return this->Settings; }
  bool HasRecovery() const { return this->Settings.Options.RecoverLostParts; }
  const SegmentationResults& Results() const { return this->Found; }
  /// The level at which the last Run() was to end.
  int EndsAt() const { return this->LastLevel; }

private:
  void ChooseEdgeLength(const SegmentationVolume& volume);
  void ChooseLevels();
  void ChooseEnd(int coarsestWithObject);
  /// Seed Positions and Attracting Positions in the workspace.
  std::vector<Point> SeedPositions() const;
  std::vector<Point> AttractingPositions() const;
  void ReadComponentChoice();
  void ReadAttraction(vtkMultiBlockDataSet* blocks);
  std::array<double, 2> RangeOfLevel(int level) const;
  LevelImage Load(int level, Executor& threads);
  void WarnOfNaNs();
  void CheckIsoValue();
  /// At most `from`; 0 where no other level has any of the object.
  int CoarsestLevelWithObject(int from);
  /// At most `from`, at least the level to end at: the coarsest on which the object is thick enough
  /// for a surface that starts there not to vanish, if that would be the end.
  int CoarsestLevelThatHolds(int from);
  void CheckObjectIsThere();
  void Start(SurfaceEvolution& evolution, const LevelImage& image);
  void Begin();
  void RunLevels();
  bool RunLevel(int level);
  void HandOverStopped(int level);
  std::string WhyStopped() const;

  SegmentationSettings Settings; ///< End as asked for; SeedRadius in the workspace
  SegmentationRequest Request;
  bool MayHaveUntoldNaNs;
  /// Keeps them alive: a shallow copy of the blocks would have other images, from VTK 9.2 on.
  std::vector<vtkSmartPointer<vtkDataObject>> Images;
  PyramidLevels Pyramid;
  std::unique_ptr<PointAttraction> Points; ///< null: none
  std::unique_ptr<EdgeLevels> Edges;       ///< null: none
  std::vector<float> Bent;                 ///< the level's voxels as the points bend them
  ComponentChoice Choice;
  int Coarsest = 0;
  int LastLevel = 0;    ///< the finest to visit
  int PreviewLevel = 0; ///< the finest to visit for a preview
  SurfaceSnapshots Film;
  SegmentationResults Found;
  std::optional<HostThreads> Threads;
  std::optional<ProgressMonitor> Watcher;
  std::unique_ptr<SurfaceEvolution> Evolution; ///< of the last two; null before the first run
  int Reached = 0;     ///< the level at which it rests
  bool GoesOn = false; ///< It does, and is fit for a finer one.
};
}

#endif

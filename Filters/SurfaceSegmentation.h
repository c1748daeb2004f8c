// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceSegmentation_h
#define SurfaceSegmentation_h

#include "AttractionInputs.h"
#include "Core/PointAttraction.h"
#include "Core/SurfaceEvolution.h"
#include "Core/SurfaceOptions.h"
#include "KeepComponents.h"
#include "ProgressMonitor.h"
#include "PyramidLevels.h"
#include "SurfaceOutput.h"
#include "SurfaceSnapshots.h"

#include <vtkSmartPointer.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkInformation;
class vtkMultiBlockDataSet;
class vtkPolyData;
class vtkTable;

namespace volumic
{
class HostThreads;

/// What a user of vtkDeformableSurface has chosen, and what hears of the work.
struct SegmentationSettings
{
  /// SeedRadius in world units; BorderValue and RecoverLostParts follow from the enumerations
  /// below.
  SurfaceOptions Options;
  int Initialization = 0; ///< vtkDeformableSurface::InitializationType, if it is one
  int BorderValue = 0;    ///< vtkDeformableSurface::BorderValueType, if it is one
  int Recovery = 0;       ///< vtkDeformableSurface::RecoveryType, if it is one
  int KeepComponents = 0; ///< vtkDeformableSurface::KeepComponentsType, if it is one
  double MinimumComponentVolume = 0.0; ///< world units cubed
  int Metric = 0;         ///< vtkDeformableSurface::MetricType, if it is one
  double EdgeLength = 0.0; ///< mean at the finest level, world units; 0: as FinestLevel has it
  bool EdgeLengthIsPlanned = false; ///< the levels were made for it, and what follows is set
  int CoarsestLevel = -1;
  int FinestLevel = 0;
  double FactorBelowLevel0 = 1.7320508075688772; ///< U_0 over the unit of level -1
  int NumberOfThreads = 0;
  bool Profile = false;                  ///< columns of the seconds of each phase in the history
  int SnapshotInterval = 0;              ///< iterations; 0: no snapshots
  vtkPolyData* InitialSurface = nullptr; ///< input port 1, may be missing
  vtkPolyData* AttractingPoints = nullptr;  ///< input port 2, may be missing
  vtkInformation* EdgeSelection = nullptr;  ///< of the map of edges; without effect at weight 0

  /// When the run began: what came before counts to the seconds of the first level.
  std::chrono::steady_clock::time_point Started = std::chrono::steady_clock::now();
  ProgressMonitor::Tell Progress;
  std::function<void(const std::string& text)> Warn;
};

/**
 * The run from the coarsest level to the finest: starts, evolves, divides, and keeps what the
 * outputs of vtkDeformableSurface hold.
 */
class SurfaceSegmentation
{
public:
  /// @param selection says which array holds the voxels (GetInputArrayInformation)
  /// @throws std::invalid_argument if the blocks are not a pyramid or a setting is out of range.
  SurfaceSegmentation(
    vtkMultiBlockDataSet* blocks, vtkInformation* selection, const SegmentationSettings& settings);
  ~SurfaceSegmentation();

  /// Where Progress asks to stop, the surface is what there is then, and marked as cancelled; it
  /// is empty where there is none yet.
  /// @throws std::invalid_argument if settings and image do not fit.
  void Run();

  vtkPolyData* Surface() const { return this->Finest; }
  vtkMultiBlockDataSet* Levels() const { return this->Blocks; }
  vtkTable* History() const { return this->Table; }
  vtkMultiBlockDataSet* Snapshots() const { return this->Film.Blocks(); }

private:
  void ChooseEdgeLength();
  void ChooseLevels();
  unsigned int BlockOf(int level) const;
  void ReadComponentChoice();
  void ReadAttraction(vtkMultiBlockDataSet* blocks);
  LevelImage Load(int level, Executor& threads);
  void CheckIsoValue();
  /// At most `from`; 0 where no other level has any of the object.
  int CoarsestLevelWithObject(int from);
  /// At most `from`, at least the level to end at: the coarsest on which the object is thick enough
  /// for a surface that starts there not to vanish, if that would be the end.
  int CoarsestLevelThatHolds(int from);
  void CheckObjectIsThere();
  void Start(SurfaceEvolution& evolution, const LevelImage& image);
  void RunLevels(HostThreads& threads, ProgressMonitor& monitor);
  bool RunLevel(SurfaceEvolution& evolution, int level);
  void MarkCancelled(int level);
  void WarnOfResult(const SurfaceDescription& end, bool keepsNone);

  SegmentationSettings Settings;
  PyramidLevels Pyramid;
  std::unique_ptr<PointAttraction> Points; ///< null: none
  std::unique_ptr<EdgeLevels> Edges;       ///< null: none
  std::vector<float> Bent;                 ///< the level's voxels as the points bend them
  ComponentChoice Choice;
  int Coarsest = 0;
  int LastLevel = 0; ///< the finest to visit
  vtkSmartPointer<vtkPolyData> Finest;
  vtkSmartPointer<vtkMultiBlockDataSet> Blocks;
  vtkSmartPointer<vtkTable> Table;
  SurfaceSnapshots Film;
};
}

#endif

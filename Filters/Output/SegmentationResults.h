// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationResults_h
#define volumicSegmentationResults_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/Workspace.h"
#include "Output/KeepComponents.h"
#include "Output/SurfaceOutput.h"
#include "Settings/SegmentationSettings.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

class vtkInformationVector;

namespace volumic
{
/**
 * What a run has found, level by level. It gives the outputs of vtkDeformableSurface as they are
 * for a run that ends at any level at which the surface rests, without another run.
 */
class SegmentationResults
{
public:
  /** A share of the object's boundary: where more is missing it matters. */
  static constexpr double NotableShare = 0.05;

  struct Level
  {
    vtkSmartPointer<vtkPolyData> Surface;     ///< the components that are chosen
    std::shared_ptr<const SurfaceResult> All; ///< with all components; null: not kept
    SurfaceDescription Description;
    bool KeepsNone = false; ///< KeepComponents has left nothing of a surface that was there.
    bool IsAtRest = false;  ///< It was not cut off while it evolved.
  };

  struct Snapshot
  {
    int Level;
    std::string Name;
    vtkSmartPointer<vtkPolyData> Surface;
  };

  /** @param size voxels of level 0 along each axis */
  explicit SegmentationResults(bool withPhases = false, int numberOfLevels = 0, int coarsest = 0,
    const Workspace& space = Workspace(), const std::array<int, 3>& size = { 0, 0, 0 });

  /** The finest level that a preview visits. */
  void SetPreviewLevel(int level) { this->PreviewLevel = level; }
  int LevelOfPreview() const { return this->PreviewLevel; }

  /**
   * Makes the surfaces those of the components that are wanted from now on.
   * @return false where they cannot be, as those of all components were not kept
   * @throws as ChoiceOf()
   */
  bool Choose(const SegmentationRequest& request, Executor& threads);
  /** Of a level, by its description: the part of it that is chosen, and whether that is none. */
  void MakeSurface(Level& result, SurfaceResult surface, Executor& threads) const;

  void SetLevel(int level, const Level& result) { this->ByLevel[level] = result; }
  /** What there is of a level, its snapshots included. */
  void Forget(int level);
  void SetRows(const std::vector<HistoryRow>& rows) { this->Rows = rows; }
  void AddSnapshot(int level, const std::string& name, vtkPolyData* surface);
  /** Output 0 of a run that was cut off, instead of the surface of a level; null: none. */
  void SetStoppedSurface(vtkPolyData* surface);

  /** Whether the surface rests at a level. */
  bool HasAtRest(int level) const;
  /** Fills them as those of a run that has ended at `last`. */
  void FillOutputs(int last, vtkInformationVector* outputs) const;
  /**
   * What is worth a warning where a run has ended at a level; empty: nothing.
   * @param wantsAll whether it matters if parts of the object are missing
   */
  std::string WarningOf(int last, bool wantsAll) const;
  /** What FillOutputs() gives as output 0. */
  vtkPolyData* Outcome(int last) const;
  vtkPolyData* SurfaceOf(int level) const { return this->ByLevel.at(level).Surface; }

  /** All levels that were set. */
  const std::map<int, Level>& Levels() const { return this->ByLevel; }

private:
  int NumberOfLevels = 0;
  int Coarsest = 0;
  int PreviewLevel = 0;
  Workspace Space;
  std::array<int, 3> Size = { 0, 0, 0 };
  ComponentChoice Choice;
  bool WithPhases = false;
  std::map<int, Level> ByLevel;
  std::vector<HistoryRow> Rows;
  std::vector<Snapshot> Snapshots;
  vtkSmartPointer<vtkPolyData> StoppedSurface;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFinishedLevels_h
#define volumicFinishedLevels_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/Workspace.h"
#include "Output/KeepComponents.h"
#include "Output/SurfaceOutput.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkInformationVector;

namespace volumic
{
/** A level at which the surface has come to rest, or was cut off. */
struct FinishedLevel
{
  SurfaceDescription About;
  bool IsAtRest = false;                    ///< It was not cut off while it evolved.
  vtkSmartPointer<vtkPolyData> Surface;     ///< the components that are chosen
  std::shared_ptr<const SurfaceResult> All; ///< with all components; null: not kept
  bool KeepsNone = false; ///< KeepComponents has left nothing of a surface that was there.
};

/**
 * The levels that a run has finished. They give the outputs of vtkDeformableSurface as they are for
 * a run that ends at any level at which the surface rests, without another run.
 */
class FinishedLevels
{
public:
  /** A share of the object's boundary: where more is missing it matters. */
  static constexpr double NotableShare = 0.05;

  FinishedLevels() = default;
  /** @param numberOfLevels of the pyramid */
  FinishedLevels(int numberOfLevels, int coarsest, const Workspace& space)
    : NumberOfLevels(numberOfLevels), Coarsest(coarsest), Space(space)
  {
  }

  /**
   * Makes the surfaces those of the components that are wanted from now on.
   * @return false where they cannot be, as those of all components were not kept
   */
  bool Choose(const ComponentChoice& choice, Executor& threads);

  /** A level with all components of its surface, which are kept on request. */
  void Add(FinishedLevel level, SurfaceResult surface, bool keepsAll, Executor& threads);
  /** What there is of a level, its snapshots included. */
  void Forget(int level);
  void AddSnapshot(int level, const std::string& name, vtkPolyData* surface)
  {
    this->Snapshots.push_back({ level, { name, surface } });
  }
  /**
   * Why a run was stopped before it came to a level, for output 0, which is the surface of the level
   * before, or none; empty: it was not.
   */
  void SetStopped(const std::string& reason) { this->StopReason = reason; }

  /** Whether the surface rests at a level. */
  bool HasAtRest(int level) const;
  /** Of a level that was added. */
  const SurfaceDescription& About(int level) const { return this->Levels.at(level).About; }

  /** The history of all levels so far. */
  void SetRows(const std::vector<HistoryRow>& rows) { this->Rows = rows; }
  /** Fills them as those of a run that has ended at `last`. */
  void FillOutputs(int last, vtkInformationVector* outputs) const;
  /**
   * What is worth a warning where a run has ended at a level; empty: nothing.
   * @param wantsAll whether it matters if parts of the object are missing
   */
  std::string WarningOf(int last, bool wantsAll) const;

private:
  void MakeSurface(FinishedLevel& level, SurfaceResult surface, Executor& threads) const;
  /** The surface for output 0 of a run that has ended at `last`. */
  vtkSmartPointer<vtkPolyData> Outcome(int last) const;

  int NumberOfLevels = 0;
  int Coarsest = 0;
  Workspace Space;
  ComponentChoice Choice;
  std::map<int, FinishedLevel> Levels;
  std::vector<std::pair<int, std::pair<std::string, vtkSmartPointer<vtkPolyData>>>> Snapshots;
  std::vector<HistoryRow> Rows;
  std::string StopReason;
};
}

#endif

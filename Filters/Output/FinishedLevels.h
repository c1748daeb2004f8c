// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicFinishedLevels_h
#define volumicFinishedLevels_h

#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/ComputationalSpace.h"
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
/** A level with its final surface, converged or stopped. */
struct FinishedLevel
{
  SurfaceDescription Description;
  bool IsConverged = false;                 ///< false: the run was stopped at this level
  vtkSmartPointer<vtkPolyData> Surface;     ///< the selected components
  std::shared_ptr<const SurfaceResult> All; ///< all components; null: not kept
  bool KeepsNone = false;                   ///< the selection has removed all components
};

/** The finished levels of a run, which fill the outputs with any of them as the finest level. */
class FinishedLevels
{
public:
  /** MissingBoundary above which the run warns. */
  static constexpr double NotableFraction = 0.05;

  FinishedLevels() = default;
  /** @param numberOfLevels number of levels of the pyramid */
  FinishedLevels(int numberOfLevels, int coarsest, const ComputationalSpace& space)
    : NumberOfLevels(numberOfLevels), Coarsest(coarsest), Space(space)
  {
  }

  /** Select components in all levels. @return false if not all components were kept */
  bool Choose(const ComponentChoice& choice, Executor& threads);

  /**
   * Add a level.
   * @param surface  all components
   * @param keepsAll whether to keep all for another selection
   */
  void Add(FinishedLevel level, SurfaceResult surface, bool keepsAll, Executor& threads);
  void Forget(int level);
  void AddSnapshot(int level, const std::string& name, vtkPolyData* surface)
  {
    this->Snapshots.push_back({ level, { name, surface } });
  }
  /**
   * Set the StopReason of output 0 for a run that was stopped before the next level. The empty text
   * resets it.
   */
  void SetStopped(const std::string& reason) { this->StopReason = reason; }

  /** Return whether the surface of a level is converged. */
  bool HasConverged(int level) const;
  /**
   * Return the components that the selection removed from output 0, with `last` as the finest
   * level. Return null with AllComponents, or if they are not kept.
   */
  vtkSmartPointer<vtkPolyData> LeftOut(int last, Executor& threads) const;
  const SurfaceDescription& DescriptionOf(int level) const
  {
    return this->Levels.at(level).Description;
  }

  void SetRows(const std::vector<HistoryRow>& rows) { this->Rows = rows; }
  /** Fill the outputs of a run with `last` as its finest level. */
  void FillOutputs(int last, vtkInformationVector* outputs) const;
  /**
   * Return the warning of a run with `last` as its finest level, or an empty text.
   * @param warnsOfMissing whether to warn of missing parts of the object
   */
  std::string WarningOf(int last, bool warnsOfMissing) const;

private:
  void MakeSurface(FinishedLevel& level, SurfaceResult surface, Executor& threads) const;
  /** Return output 0 of a run with `last` as its finest level. */
  vtkSmartPointer<vtkPolyData> Outcome(int last) const;

  int NumberOfLevels = 0;
  int Coarsest = 0;
  ComputationalSpace Space;
  ComponentChoice Choice;
  std::map<int, FinishedLevel> Levels;
  std::vector<std::pair<int, std::pair<std::string, vtkSmartPointer<vtkPolyData>>>> Snapshots;
  std::vector<HistoryRow> Rows;
  std::string StopReason;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionImplementation_h
#define volumicEvolutionImplementation_h

#include "Core/Evolution/CycleCriterion.h"
#include "Core/Evolution/LostBoundary.h"
#include "Core/Evolution/RestCriterion.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Image/Field.h"
#include "Core/Surface/SurfaceState.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

namespace volumic
{
/**
 * What SurfaceEvolution hides. EvolutionStart.cxx brings the surface to a level (start, division,
 * recovery), GivenSurface.cxx makes a given one ready, EvolutionRun.cxx iterates until it rests and
 * regularises it, EvolutionHistory.cxx tells of it.
 */
struct SurfaceEvolution::Implementation
{
  SurfaceOptions Options;
  Executor& Threads;
  Monitor& Listener;
  SurfaceState State;
  std::unique_ptr<Field> TheField;
  int Level = 0;
  std::vector<HistoryRow> Rows;
  int LastIterations = 0;
  LostParts LastLost;
  LostBoundary Lost; ///< Of the parts that the last division found.
  SurfaceIteration Iteration;
  RestCriterion Rest;
  CycleCriterion Cycle;
  double WantedMeanEdge = 0.; ///< See SurfaceEvolution::SetMeanEdgeLength.
  HistoryRow Preparing; ///< Phases before the first iteration of a level: start or division.
  std::chrono::steady_clock::time_point LastLap = std::chrono::steady_clock::now();
  double LevelSeconds = 0.; ///< Of all laps since the last level.
  bool Stopped = false;     ///< By the monitor.
  EditCounts SinceEvolved; ///< Of what is like an iteration, but after the last one of a level.

  Implementation(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
    : Options(options)
    , Threads(executor)
    , Listener(monitor)
    , Iteration(this->State, executor)
  {
  }

  bool Ask(
    bool (Monitor::*question)(const Monitor::Status&), Monitor::Activity doing, double share);
  bool GoOn(Monitor::Activity doing, double share);
  Checkpoint CheckpointOf(Monitor::Activity doing, double from = 0., double to = 1.);
  bool HasIteration() const;
  double Lap();
  void Enter(const LevelImage& image, int level);
  void Reset();
  void Recover();
  void LayGrid();
  void SplitLongEdges();
  void FindIntersections();
  void DivideOnce();
  void Take(const IndexedSurface& surface);
  void TakeRemeshed(const IndexedSurface& surface);
  IndexedSurface Remesh(const IndexedSurface& surface);
  void Begin(const IndexedSurface& surface);
  void Adapt();
  void ActivateAll();
  void KeepActiveIfMoving();
  void Iterate(
    HistoryRow& row, Dynamics& dynamics, Remesher& remesher, SurfaceIteration::Mode mode);
  void FillRow(HistoryRow& row);
  double MeanEdgeLength() const;
  void FillCounts(HistoryRow& row) const;
  void FitMeanEdge(Dynamics& dynamics);
  void DeleteInsideOut();
  void FinishRow();
  void FindMissing();
  void Regularise(Dynamics& dynamics);
  void RunPolish(HistoryRow& row);
  StopReason Evolve();
  StopReason Run();
};
}

#endif

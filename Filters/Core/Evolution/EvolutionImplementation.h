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
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceComponents.h"
#include "Core/Surface/SurfaceState.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace volumic
{
/**
 * What SurfaceEvolution hides. EvolutionStart.cxx brings the surface to a level (start, division,
 * recovery; the divisions are in EvolutionDivision.cxx), GivenSurface.cxx makes a given one ready,
 * EvolutionRun.cxx iterates until it rests and regularises it, EvolutionVisits.cxx makes the visits
 * for both, EvolutionComponents.cxx labels its components between these, EvolutionGrading.cxx divides
 * it here and there, and gives it longer edges where it is flat, EvolutionVerification.cxx has a last
 * look at it, EvolutionHistory.cxx tells of it.
 *
 * All is called on the thread that calls SurfaceEvolution, but for what a visit calls (VisitBlock,
 * VisitToEvolve, TakeIteration), which is called on any thread. The listener is asked on the
 * calling thread only.
 */
struct SurfaceEvolution::Implementation
{
  /** Of a regularisation, the passes; the rest is the polish. */
  static constexpr double PassesShare = 0.6;

  SurfaceOptions Options;
  Executor& Threads;
  Monitor& Listener;
  SurfaceState State;
  std::unique_ptr<Field> TheField;
  int Level = 0;
  std::vector<HistoryRow> Rows;
  bool HasDescended = false; ///< See DescendField; of this level.
  int LastIterations = 0;
  LostParts LastLost;
  LostBoundary Lost; ///< The boundary of the parts that were lost at the last division.
  int NumberOfComponents = 0; ///< As they were labelled last.
  int Unchecked = 1; ///< Starts, cuts and deletions since components were judged from outside in.
  std::vector<std::unique_ptr<SurfaceIteration>> Iterations; ///< Of visits, one for each thread.
  std::vector<SurfaceIteration*> Idle;                       ///< Those of them in no visit.
  std::mutex Handing; ///< Held while a visit takes one of them, or changes what all visits share.
  RestCriterion Rest;
  CycleCriterion Cycle;
  double WantedMeanEdge = 0.; ///< See SurfaceEvolution::SetMeanEdgeLength.
  Grading WantedGrading;      ///< See SurfaceEvolution::SetGrading.
  HistoryRow Preparing; ///< The phases before a level's first iteration: start or division.
  std::chrono::steady_clock::time_point LastLap = std::chrono::steady_clock::now();
  double LevelSeconds = 0.; ///< Of all laps since the last level.
  bool Stopped = false;     ///< The monitor has said stop; it is not asked again.
  Verdict LastVerdict;
  bool IsMending = false;   ///< Faces that intersect are being mended: nobody is asked meanwhile.
  // There are these while a surface lies on a level (MakeBlocks), else null:
  std::unique_ptr<SurfaceBlocks> Blocks;
  std::unique_ptr<SurfaceComponents> Components;
  struct
  {
    int Sweep = 0;  ///< Of the level, from 1.
    int Active = 0; ///< How many vertices were active in the last sweep.
    int Block = 0;  ///< How many visits of this sweep are done, and
    int Blocks = 0; ///< how many there are at most.
    double Iterations = 0.; ///< How many of the sweep's iterations are done, as an estimate.
    double Volume = 0.;     ///< Of the surface after the last sweep.
  } Visit;
  EditCounts SinceEvolved; ///< Edits after the last iteration of a level.

  /** A sweep over blocks: what is done in each. */
  struct BlockVisits
  {
    bool OnlyActive = true; ///< Blocks in which nothing may move are left out.
    bool IsAsked = true;    ///< The listener is told, and may stop it.
    Monitor::Activity Doing = Monitor::Activity::Iterating;
    double From = 0.; ///< The share of the activity that is done before the sweep, and
    double To = 1.;   ///< after it.
    double Iterations = 0.; ///< How many a visit makes.
    /**
     * Called on any thread. The sum of what the visits have edited is in State.Counts afterwards.
     */
    std::function<void(BlockVisit& visit, SurfaceIteration& iteration)> Visit;
  };
  /** What one iteration, made in all the blocks of a sweep, adds to the history. */
  struct SweptRow
  {
    HistoryRow Row;
    EditCounts Counts;
    int Vertices = 0; ///< By how many there are more.
    int EulerCharacteristic = 0;
    std::vector<double> KineticEnergy; ///< Of each block, summed up over its vertices.
  };

  Implementation(const SurfaceOptions& options, Executor& executor, Monitor& monitor)
    : Options(options)
    , Threads(executor)
    , Listener(monitor)
  {
  }

  bool Ask(
    bool (Monitor::*question)(const Monitor::Status&), Monitor::Activity doing, double share);
  bool GoOn(Monitor::Activity doing, double share);
  ProgressQuestion QuestionOf(Monitor::Activity doing, double from = 0., double to = 1.);
  bool HasIteration() const;
  double Lap();
  void Enter(const LevelImage& image, int level);
  void Clear();
  /** Forgets all but the mesh, numbers its vertices along a curve, and lays it out. */
  void Reset();
  /** Makes grid, blocks and labels of a mesh of which nothing else is known; splits long edges. */
  void LayOut();
  void Recover();
  Box BoxOfGrid() const;
  void LayGrid();
  bool HasEdgeTooLong() const;
  int CountIntersecting();
  void Verify();
  /** Splits all edges that are too long; it cannot be stopped. */
  void SplitLongEdges();
  /** @param visits tell whom to ask whether to go on; after a stop some long edges are left */
  void SplitLongEdges(BlockVisits visits);
  float LongestEdge() const;
  std::vector<Proximity::FacePair> FindIntersections();
  void DivideOnce();
  bool DivideAll(int divisions); ///< @return whether nothing asked to stop
  SurfaceBlocks::Frame FrameOfLevel() const;
  void MakeBlocks(); ///< Those of the mesh as it is.
  void ForgetBlocks(); ///< Any new vertex may have their places again.
  std::vector<int> AliveVertices() const;
  /** @param isSound it has been made well: its edges need not be legal already */
  void Take(const IndexedSurface& surface, bool isSound);
  void TakeRemeshed(const IndexedSurface& surface);
  IndexedSurface Remesh(const IndexedSurface& surface);
  void Begin(const IndexedSurface& surface);
  void Adapt();
  void ActivateAll();

  // By visits: EvolutionVisits.cxx.
  SurfaceIteration& TakeIteration();
  void VisitBlock(int block, const BlockVisits& visits, Executor& idle);
  /** A sweep. After a stop some blocks were not visited; the surface is valid all the same. */
  void VisitBlocks(const BlockVisits& visits);
  /** A sweep of a few iterations. Adds their rows to the history, and labels the components. */
  void RunSweep(const Dynamics& dynamics);
  void VisitToEvolve(BlockVisit& visit, SurfaceIteration& iteration, const Dynamics& dynamics,
    std::vector<SweptRow>& rows);
  void KeepSweptRows(std::vector<SweptRow>& rows, int vertices, int eulerCharacteristic);
  /** A sweep that makes some iterations in each block with active vertices; no rows are kept. */
  void VisitAll(SurfaceIteration::Mode mode, const Dynamics& dynamics, int iterations,
    Monitor::Activity doing, double from, double to);
  void KeepActiveIfMoving(const SurfaceIteration& iteration);
  void RunPasses(const Dynamics& dynamics);
  void Polish(const std::function<bool(int v)>& isWanted);
  double KineticEnergy(const SurfaceIteration& iteration) const;
  double Volume() const;
  double Area() const;

  void LabelComponents();
  void BeginRow(HistoryRow& row);
  void KeepRow(const HistoryRow& row);
  double MeanEdgeLength() const;
  void FillCounts(HistoryRow& row) const;
  void FitMeanEdge(const Dynamics& dynamics);
  // EvolutionGrading.cxx:
  /**
   * From a level of this delta: only where what is seen on the new one asks for shorter edges.
   * @return false where a tolerance asks for them at more than half of the vertices: then all is to
   *         be divided, and laid out
   */
  bool DivideWhereWanted(double delta);
  /** The same about parts that are lost, so that these can be enclosed beside it. */
  void DivideNear(const LostBoundary& lost);
  void Grade(const Dynamics& dynamics);
  /** @param visits that split edges, see SplitLongEdges */
  void ApplySizes(const std::vector<int>& changed, const BlockVisits& visits);
  void DeleteInsideOut();
  void DeleteThoseInsideOut();
  void DeleteDegenerate();
  void FinishRow();
  void FindMissing();
  void Regularise(const Dynamics& dynamics);
  /**
   * Before a division: from the isopotential of the level before onto that of this one, as far as
   * verified passes lead, while there are a third as many vertices. @param delta of the level before
   */
  void DescendField(double delta);
  /**
   * Makes those active that are further than this (in delta) off the isopotential, and those beside
   * them; all others rest. @return whether there are any
   */
  bool ActivateWhereOff(float least);
  void Revise(const LevelImage& image);
  /**
   * Sweeps until the level rests, goes in circles, has had its iterations, vanishes or is stopped.
   * Before and after each sweep the surface is closed, oriented, manifold and free of
   * intersections, its components are labelled, and the history has a row for each iteration.
   */
  StopReason Evolve();
  /**
   * Evolve(), then what ends a level, also after a stop: nothing inside out or unverified stays.
   */
  StopReason Run();
};
}

#endif

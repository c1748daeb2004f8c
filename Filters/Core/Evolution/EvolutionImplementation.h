// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionImplementation_h
#define volumicEvolutionImplementation_h

#include "Core/Common/Communicator.h"
#include "Core/Evolution/CycleCriterion.h"
#include "Core/Evolution/LostBoundary.h"
#include "Core/Evolution/RestCriterion.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Core/Evolution/SurfaceIteration.h"
#include "Core/Image/Field.h"
#include "Core/Mesh/Division.h"
#include "Core/Surface/RankBlocks.h"
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
 * for both, EvolutionRanks.cxx on several ranks, RankResult.cxx puts together what these have,
 * EvolutionGrading.cxx divides it here and there, and gives it longer edges where it is flat,
 * EvolutionVerification.cxx has a last look at it, EvolutionHistory.cxx tells of it.
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
  int LastIterations = 0;
  LostParts LastLost;
  LostBoundary Lost; ///< Of the parts that the last division found.
  int NumberOfComponents = 0; ///< When last labelled.
  int Unchecked = 1; ///< Starts, cuts and deletions since components were judged from outside in.
  std::vector<std::unique_ptr<SurfaceIteration>> Iterations; ///< Of visits, one for each thread.
  std::vector<SurfaceIteration*> Idle;                       ///< Of them, those in no visit.
  std::mutex Handing; ///< Held while visits take them, or add to what is all visits'.
  RestCriterion Rest;
  CycleCriterion Cycle;
  double WantedMeanEdge = 0.; ///< See SurfaceEvolution::SetMeanEdgeLength.
  Grading WantedGrading;      ///< See SurfaceEvolution::SetGrading.
  HistoryRow Preparing; ///< Phases before the first iteration of a level: start or division.
  std::chrono::steady_clock::time_point LastLap = std::chrono::steady_clock::now();
  double LevelSeconds = 0.; ///< Of all laps since the last level.
  bool Stopped = false;     ///< By the monitor.
  Verdict LastVerdict;
  bool IsMending = false;   ///< Which is not stopped.
  bool IsShared = false;    ///< The level is worked on by all ranks.
  Communicator* Ranks = &OnThisRank();
  // Once a level has begun:
  std::unique_ptr<SurfaceBlocks> Blocks;
  std::unique_ptr<RankBlocks> Piece; ///< Of this rank; one alone has the whole surface.
  std::unique_ptr<SurfaceComponents> Components; ///< Of all pieces.
  std::function<void(const VoxelBox&)> NeedVoxels; ///< See SetRanks.
  Vector GridLow, GridHigh;              ///< As the grid was laid last.
  struct
  {
    int Sweep = 0;  ///< Of the level, from 1.
    int Active = 0; ///< Vertices, in the last one.
    int Block = 0;  ///< Visits of this sweep, and
    int Blocks = 0; ///< how many there are at most.
    double Iterations = 0.; ///< Beyond LastIterations: an estimate.
  } Visit;
  EditCounts SinceEvolved; ///< Of what is like an iteration, but after the last one of a level.

  /** A sweep over blocks: what is done in each. */
  struct BlockVisits
  {
    bool OnlyActive = true; ///< Blocks in which nothing may move are left out.
    bool IsAsked = true;    ///< The listener is told, and may stop it.
    Monitor::Activity Doing = Monitor::Activity::Iterating;
    double From = 0.; ///< Shares of the activity, before and after.
    double To = 1.;
    double Iterations = 0.; ///< That a visit makes.
    /** On any thread; State::Counts is the sum of the shares' afterwards. */
    std::function<void(BlockVisit& visit, SurfaceIteration& iteration)> Visit;
  };
  /** An iteration in all the blocks of a sweep. */
  struct SweptRow
  {
    HistoryRow Row;
    EditCounts Counts;
    int Vertices = 0; ///< How many more there are.
    int EulerCharacteristic = 0;
    std::vector<double> KineticEnergy; ///< Of each block.
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
  void Reset(); ///< All is forgotten but the mesh, whose vertices get their numbers along a curve.
  void LayOut(); ///< The same with the numbers that they have.
  void Recover();
  void FindGridBox(const SurfaceMesh& mesh);
  void LayGrid();
  bool HasEdgeTooLong() const;
  int CountIntersecting();
  void Verify();
  void SplitLongEdges(); ///< All of them, whoever asks to stop.
  /** @param visits whom they ask whether to go on; where they are stopped some edges are left */
  void SplitLongEdges(BlockVisits visits);
  float LongestEdge(); ///< On all ranks.
  std::vector<Proximity::FacePair> FindIntersections();
  void DivideOnce();
  bool DivideWhole(int divisions); ///< @return whether nothing asked to stop
  void KeepEdgesAbout(const std::vector<Proximity::FacePair>& pairs,
    const LargeVector<Triangle>& faces, const SurfaceMesh& old, int round, KeptEdges& kept);
  SurfaceBlocks::Frame FrameOfLevel() const;
  /** @param sharers whose they will be; one rank has all of them */
  void MakeBlocks(Communicator& sharers = OnThisRank());
  void ForgetBlocks(); ///< Their places are anyone's again.
  std::vector<int> OwnVertices() const;
  // From a surface that is whole on rank 0 to one that is in pieces, with so many divisions.
  bool LayOutInPieces(int divisions);
  void DivideInPieces();
  void SpreadWhole();
  void SpreadMesh();
  void LayGridOfPiece();
  std::vector<Proximity::FacePair> FindIntersectionsInPieces();
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
  void VisitBlocks(const BlockVisits& visits);
  void RunSweep(const Dynamics& dynamics);
  void VisitToEvolve(BlockVisit& visit, SurfaceIteration& iteration, const Dynamics& dynamics,
    std::vector<SweptRow>& rows);
  /** @param inside seconds of the sweep that were spent within For() of a MeasuredExecutor */
  void KeepSweptRows(
    std::vector<SweptRow>& rows, int vertices, int eulerCharacteristic, double inside);
  /** Some iterations in each block that has active vertices. */
  void VisitAll(SurfaceIteration::Mode mode, const Dynamics& dynamics, int iterations,
    Monitor::Activity doing, double from, double to);
  void KeepActiveIfMoving(const SurfaceIteration& iteration);
  void RunPasses(const Dynamics& dynamics);
  void Polish(const std::function<bool(int v)>& isWanted);
  double SumOfBlocksOf(const std::function<double(int v)>& ofVertex) const;
  double KineticEnergy(const SurfaceIteration& iteration) const;
  double Area();
  double Volume();

  // On several ranks: EvolutionRanks.cxx.
  /** Those that have pieces of the surface as it is now: one while it is whole. */
  Communicator& Sharers() const { return this->Piece ? this->Piece->Sharers() : OnThisRank(); }
  bool IsInPieces() const { return this->Piece && this->Piece->AreShared(); }
  void BeginVisits();
  void EndVisits();
  bool IsFirstRank() const { return this->Ranks->Rank() == 0; }
  void ShareBlocks(const SurfaceMesh& mesh);
  void AgreeOnGridBox();
  VoxelBox OwnVoxels() const;
  void VisitBlocksOnRanks(
    const BlockVisits& visits, const std::function<bool(std::size_t done)>& goOn);
  void AgreeOnStop();
  bool IsOnAnyRank(bool isHere);
  void AddUpRows(std::vector<SweptRow>& rows);
  void AddUpSinceEvolved();
  std::vector<std::uint8_t> AreNear(std::vector<std::int64_t> voxels);
  void Unite();
  SurfaceResult ResultOnRanks() const;
  void CountComponents();
  void LabelComponents();
  void BeginRow(HistoryRow& row);
  void KeepRow(const HistoryRow& row);
  double MeanEdgeLength();
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
  void Revise(const LevelImage& image);
  StopReason Evolve();
  StopReason Run();
};
}

#endif

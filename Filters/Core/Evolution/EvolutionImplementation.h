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
#include "Core/Surface/RankComponents.h"
#include "Core/Surface/SurfaceBlocks.h"
#include "Core/Surface/SurfaceState.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace volumic
{
/**
 * What SurfaceEvolution hides. EvolutionStart.cxx brings the surface to a level (start, division,
 * recovery; the divisions are in EvolutionDivision.cxx), GivenSurface.cxx makes a given one ready,
 * EvolutionRun.cxx iterates until it rests and regularises it, EvolutionSweeps.cxx does so block by
 * block, EvolutionRanks.cxx on several ranks, RankResult.cxx puts together what these have,
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
  SurfaceIteration Iteration;
  RestCriterion Rest;
  CycleCriterion Cycle;
  double WantedMeanEdge = 0.; ///< See SurfaceEvolution::SetMeanEdgeLength.
  HistoryRow Preparing; ///< Phases before the first iteration of a level: start or division.
  std::chrono::steady_clock::time_point LastLap = std::chrono::steady_clock::now();
  double LevelSeconds = 0.; ///< Of all laps since the last level.
  bool Stopped = false;     ///< By the monitor.
  Verdict LastVerdict;
  bool IsMending = false;   ///< Which is not stopped.
  bool InSweeps = false;    ///< The level evolves block by block: EvolutionSweeps.cxx.
  std::unique_ptr<SurfaceBlocks> Blocks; ///< While it does.
  Communicator* Ranks = nullptr;         ///< Null: alone.
  std::function<void(const VoxelBox&)> NeedVoxels; ///< See SetRanks.
  std::unique_ptr<RankBlocks> OnRanks;   ///< While the surface is in parts: EvolutionRanks.cxx.
  std::unique_ptr<RankComponents> OfRanks; ///< Once there have been ranks.
  int Visiting = NoBlock;                ///< The block that is being visited.
  Vector GridLow, GridHigh;              ///< As the grid was laid last.
  struct
  {
    int Sweep = 0;  ///< From 1; 0: the level evolves as a whole.
    int Block = 0;  ///< Visits of this sweep, and
    int Blocks = 0; ///< how many there are at most.
    double Iterations = 0.; ///< Beyond LastIterations: an estimate.
    double From = 0.; ///< Shares of the activity before and after the visit.
    double To = 0.;
  } Visit;
  EditCounts SinceEvolved; ///< Of what is like an iteration, but after the last one of a level.

  /** A sweep over blocks: what is done in each. */
  struct BlockVisits
  {
    bool OnlyActive = true; ///< Blocks in which nothing may move are left out.
    Monitor::Activity Doing = Monitor::Activity::Iterating;
    double From = 0.; ///< Shares of the activity, before and after.
    double To = 1.;
    double Iterations = 0.; ///< That a visit makes.
    std::function<void(const std::vector<int>& vertices)> Visit; ///< The list may grow.
  };
  /** An iteration in all the blocks of a sweep. */
  struct SweptRow
  {
    HistoryRow Row;
    int Vertices = 0; ///< How many more there are.
    int EulerCharacteristic = 0;
    std::vector<double> KineticEnergy; ///< Of each block.
  };

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
  void FindGridBox(const SurfaceMesh& mesh);
  void LayGrid();
  void Append(const IndexedSurface& surface);
  bool HasEdgeTooLong() const;
  int CountIntersecting();
  void Verify();
  void SplitLongEdges();
  float LongestEdge(); ///< On all ranks.
  std::vector<Proximity::FacePair> FindIntersections();
  void DivideOnce();
  void KeepEdgesAbout(const std::vector<Proximity::FacePair>& pairs,
    const LargeVector<Triangle>& faces, const SurfaceMesh& old, int round, KeptEdges& kept);
  // The same for a level in sweeps.
  SurfaceBlocks::Frame FrameOfLevel() const;
  bool DivideInBlocks();
  void SpreadMesh();
  void LayGridInBlocks();
  std::vector<int> OwnVertices() const;
  std::vector<Proximity::FacePair> FindIntersectionsInBlocks();
  void SplitLongEdgesInBlocks();
  /** @param isSound it has been made well: its edges need not be legal already */
  void Take(const IndexedSurface& surface, bool isSound);
  void TakeRemeshed(const IndexedSurface& surface);
  IndexedSurface Remesh(const IndexedSurface& surface);
  void Begin(const IndexedSurface& surface);
  void Adapt();
  void ActivateAll();
  void KeepActiveIfMoving();
  void Iterate(
    HistoryRow& row, Dynamics& dynamics, Remesher& remesher, SurfaceIteration::Mode mode);
  void IterateOnce(Dynamics& dynamics, Remesher& remesher);
  void DecideOnSweeps();
  void BeginSweeps();
  void EndSweeps();
  void AddPlaces();
  Box AboutBlock() const;
  bool VisitBlock(int block, std::size_t visited, const BlockVisits& visits);
  void VisitBlocks(const BlockVisits& visits);
  void RunSweep(Dynamics& dynamics, Remesher& remesher);
  void VisitToEvolve(const std::vector<int>& vertices, Dynamics& dynamics, Remesher& remesher,
    std::vector<SweptRow>& rows);
  double SumOfBlocksOf(const std::function<double(int v)>& ofVertex);
  double Area();
  double Volume();
  void KeepSweptRows(std::vector<SweptRow>& rows, int vertices, int eulerCharacteristic);
  void RunPasses(Dynamics& dynamics, Remesher& remesher);
  void RegulariseInSweeps(Dynamics& dynamics, Remesher& remesher);
  void PolishInSweeps();

  // On several ranks: EvolutionRanks.cxx.
  bool AreRanks() const { return this->Ranks && this->Ranks->NumberOfRanks() > 1; }
  bool IsFirstRank() const { return !this->AreRanks() || this->Ranks->Rank() == 0; }
  void ShareBlocks(const SurfaceMesh& mesh);
  void AgreeOnGridBox();
  VoxelBox OwnVoxels() const;
  void VisitBlocksOnRanks(const BlockVisits& visits);
  void AgreeOnStop();
  bool IsOnAnyRank(bool isHere);
  void AddUpRows(std::vector<SweptRow>& rows);
  void AddUpSinceEvolved();
  std::vector<std::uint8_t> AreNearOnRanks(std::vector<std::int64_t> voxels);
  void Unite();
  SurfaceResult ResultOnRanks() const;
  RankComponents& ComponentsOfRanks();
  void TakeComponents(bool areChecked);
  void LabelComponents();
  void BeginRow(HistoryRow& row);
  void KeepRow(const HistoryRow& row);
  double KineticEnergy() const;
  void FillRow(HistoryRow& row);
  double MeanEdgeLength();
  void FillCounts(HistoryRow& row) const;
  void FitMeanEdge(Dynamics& dynamics);
  void DeleteInsideOut();
  void DeleteThoseInsideOut();
  void DeleteDegenerate();
  void FinishRow();
  void FindMissing();
  void Regularise(Dynamics& dynamics);
  void Revise(const LevelImage& image);
  std::vector<int> Polish(const Checkpoint& goOn, const std::vector<int>* vertices);
  void PolishAll();
  StopReason Evolve();
  StopReason Run();
};
}

#endif

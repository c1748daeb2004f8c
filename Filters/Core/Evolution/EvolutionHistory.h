// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionHistory_h
#define volumicEvolutionHistory_h

#include "Core/Surface/SurfaceState.h"

#include <array>
#include <chrono>
#include <mutex>
#include <vector>

namespace volumic
{
/** Parts of an iteration, and of what lies between two, in the order of HistoryRow::PhaseSeconds.
 */
enum class Phase
{
  Forces,
  Contact,
  Proximity,
  Verification,
  Remeshing,
  Topology,
  Division,       ///< Division, start.
  Recovery,       ///< Of lost parts.
  Regularisation, ///< The final one.
  Count
};

/**
 * One iteration, and what comes before the first and after the last one of a level. Lengths are
 * those of the workspace.
 *
 * What happens to the Euler characteristic is explained row by row:
 *
 *   IterationEulerCharacteristic = EulerCharacteristic of the row before, 0 in the first,
 *     + AddedEulerCharacteristic + 2 (Cuts - Merges - Deletions + DeletedGenus)
 *   EulerCharacteristic = IterationEulerCharacteristic
 *     + 2 (RegularisationCuts - RegularisationDeletions)
 *
 * (and, if a regularisation should ever delete a component with handles, twice their number).
 * SecondsBefore, Seconds and SecondsAfter of all rows follow each other without a gap. Iterations
 * are made in sweeps of five over the blocks (SurfaceBlocks): a row adds up what all blocks did in
 * the same one; MeanEdgeLength and Components are those at the end of the sweep, TimeStep the
 * longest.
 */
struct HistoryRow
{
  int Iteration = 0; ///< Counted over all levels, from 1.
  int Level = 0;
  int Vertices = 0;
  double KineticEnergy = 0.; ///< Mean over vertices of half the squared speed along the normal.
  double MeanEdgeLength = 0.;
  double Seconds = 0.; ///< Of those of its sweep, what was spent in this iteration.
  double TimeStep = 0.;
  int ActiveVertices = 0;
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  /** Like Vertices, MeanEdgeLength, Components: in the last row of a level as regularised. */
  int EulerCharacteristic = 0;
  int Components = 0;
  int Recovered = 0;    ///< Lost parts and cavities enclosed again before the first of a level.
  int Deletions = 0;    ///< Components deleted.
  int DeletedGenus = 0; ///< Sum of their genera.
  /** Of what came new before this iteration: the start, what encloses lost parts. */
  int AddedEulerCharacteristic = 0;
  /** What the iteration itself has left: the same but for the last one of a level. */
  int IterationVertices = 0;
  double IterationMeanEdgeLength = 0.;
  int IterationEulerCharacteristic = 0;
  int IterationComponents = 0;
  int RegularisationCuts = 0;
  int RegularisationDeletions = 0;
  double SecondsBefore = 0.; ///< Between the row before, or the start of the clock, and this one.
  double SecondsAfter = 0.;  ///< After the last iteration of a level, until EndLevel().
  std::array<double, static_cast<int>(Phase::Count)> PhaseSeconds{};

  void Add(const EditCounts& counts);
  /** What another block did in the same iteration; the longer of the two time steps. */
  void Add(const HistoryRow& row);
};

/**
 * What the iterations of a sweep add to the history, while blocks are visited: of vertices and
 * Euler characteristic by how many there are more.
 */
class SweptRows
{
public:
  SweptRows(int iterations, int blocks);
  /** What a visit did in each of the iterations. On any thread. */
  void Add(int block, const std::vector<HistoryRow>& rows);
  /** Of each iteration; the kinetic energy, to be summed in the order of the blocks, apart. */
  std::vector<HistoryRow> Rows;
  std::vector<std::vector<double>> KineticEnergy;

private:
  std::mutex Adding;
};

/** A surface between two sweeps, in numbers. */
struct SurfaceNumbers
{
  int Vertices = 0;
  int EulerCharacteristic = 0;
  int Components = 0;
  double MeanEdgeLength = 0.;
};

/** Looks on as a surface evolves: a row for each iteration of all levels, and clocks. */
class EvolutionHistory
{
public:
  using Clock = std::chrono::steady_clock;

  std::vector<HistoryRow> Rows;
  /** What comes before a level's first iteration: its phases, and what is recovered. */
  HistoryRow Pending;

  /** When the time begins that counts to the next row. */
  void StartClock(Clock::time_point start) { this->LastLap = start; }

  void BeginLevel(int level);
  /** On the level. */
  int Iterations() const { return this->OfLevel; }

  void BeginSweep(int vertices, int eulerCharacteristic);
  /** Takes the rows of a sweep that is over. */
  void EndSweep(SweptRows& swept, const SurfaceNumbers& after);
  /** What the regularisation, and all that comes after the last sweep, has edited. */
  void CountAfterwards(const EditCounts& edits) { this->Afterwards += edits; }
  /** After that the last row tells of the surface as it is handed over. */
  void Finish(const SurfaceNumbers& regularised);

  /** To be called when all is done with the surface of a level: the seconds until now are its. */
  void EndLevel();

private:
  double Lap();

  int Level = 0;
  int OfLevel = 0;
  int Vertices = 0;            ///< Before the last sweep.
  int EulerCharacteristic = 0; ///< Likewise.
  EditCounts Afterwards;
  double SecondsBefore = 0.; ///< The last sweep.
  Clock::time_point LastLap = Clock::now();
};

/** Adds the time since it was made, or since the last call, to a phase. */
class Stopwatch
{
public:
  /** The row must outlive the object. */
  explicit Stopwatch(HistoryRow& row) : Row(row), Last(EvolutionHistory::Clock::now()) {}

  void Lap(Phase phase)
  {
    const auto now = EvolutionHistory::Clock::now();
    this->Row.PhaseSeconds[static_cast<int>(phase)] +=
      std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
  }

private:
  HistoryRow& Row;
  EvolutionHistory::Clock::time_point Last;
};
}

#endif

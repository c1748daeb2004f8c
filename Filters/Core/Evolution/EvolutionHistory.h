// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicEvolutionHistory_h
#define volumicEvolutionHistory_h

#include "Core/Surface/SurfaceState.h"

#include <chrono>
#include <mutex>
#include <vector>

namespace volumic
{
/**
 * An iteration. Lengths are those of the workspace. Iterations are made in sweeps of five over the
 * blocks (SurfaceBlocks): a row adds up what all blocks did in the same one. MeanEdgeLength and
 * Components are those at the end of the sweep. In the last row of a level Vertices, MeanEdgeLength,
 * EulerCharacteristic and Components are those of the surface that the level hands over.
 */
struct HistoryRow
{
  int Iteration = 0; ///< Counted over all levels, from 1.
  int Level = 0;
  int Vertices = 0;
  double KineticEnergy = 0.; ///< Mean over vertices of half the squared speed along the normal.
  double MeanEdgeLength = 0.;
  double Seconds = 0.; ///< Since the row before; see EvolutionHistory::EndSweep() and EndLevel().
  double TimeStep = 0.; ///< The longest of all blocks.
  int ActiveVertices = 0;
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  int EulerCharacteristic = 0;
  int Components = 0;

  void Add(const EditCounts& counts);
  /** Add what another block did in the same iteration. */
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

/** Looks on as a surface evolves: a row for each iteration of all levels. */
class EvolutionHistory
{
public:
  using Clock = std::chrono::steady_clock;

  std::vector<HistoryRow> Rows;

  /** When the time begins that counts to the next row. */
  void StartClock(Clock::time_point start) { this->LastLap = start; }

  void BeginLevel(int level);
  /** On the level. */
  int Iterations() const { return this->OfLevel; }

  void BeginSweep(int vertices, int eulerCharacteristic);
  /** Takes the rows of a sweep that is over; they share its seconds, and the first has those before.
   */
  void EndSweep(SweptRows& swept, const SurfaceNumbers& after);
  /** After that the last row tells of the surface as it is handed over. */
  void Finish(const SurfaceNumbers& regularised);

  /** Add the seconds until now to the last row, when all is done with the surface of a level. */
  void EndLevel();

private:
  double Lap();

  int Level = 0;
  int OfLevel = 0;
  int Vertices = 0;            ///< Before the last sweep.
  int EulerCharacteristic = 0; ///< Likewise.
  double SecondsBefore = 0.;   ///< The last sweep.
  Clock::time_point LastLap = Clock::now();
};
}

#endif

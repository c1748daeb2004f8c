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
 * One iteration, summed over all blocks. Lengths are in the computational space. MeanEdgeLength and
 * Components are those at the end of the sweep of five iterations. In the last row of a level,
 * Vertices, MeanEdgeLength, EulerCharacteristic and Components describe the final surface.
 */
struct HistoryRow
{
  int Iteration = 0; ///< over all levels, from 1
  int Level = 0;
  int Vertices = 0;
  double KineticEnergy = 0.; ///< mean over vertices of half the squared normal speed
  double MeanEdgeLength = 0.;
  double Seconds = 0.;  ///< since the previous row
  double TimeStep = 0.; ///< maximum over all blocks
  int ActiveVertices = 0;
  int Merges = 0;
  int Cuts = 0;
  int Splits = 0;
  int Collapses = 0;
  int Flips = 0;
  int EulerCharacteristic = 0;
  int Components = 0;

  void Add(const EditCounts& counts);
  /** Add another block's part of the same iteration. */
  void Add(const HistoryRow& row);
};

/**
 * Rows of a sweep in progress. Vertices and EulerCharacteristic are differences.
 */
class SweptRows
{
public:
  SweptRows(int iterations, int blocks);
  /** Add the iterations of a block pass. Thread-safe. */
  void Add(int block, const std::vector<HistoryRow>& rows);
  /** By iteration. The kinetic energies of all blocks are summed in the order of the blocks. */
  std::vector<HistoryRow> Rows;
  std::vector<std::vector<double>> KineticEnergy;

private:
  std::mutex Adding;
};

/** Numbers of a surface between two sweeps. */
struct SurfaceNumbers
{
  int Vertices = 0;
  int EulerCharacteristic = 0;
  int Components = 0;
  double MeanEdgeLength = 0.;
};

/** History of an evolution: a row per iteration of all levels. */
class EvolutionHistory
{
public:
  using Clock = std::chrono::steady_clock;

  std::vector<HistoryRow> Rows;

  /** Set the start of the time that the next row includes. */
  void StartClock(Clock::time_point start) { this->LastLap = start; }

  void BeginLevel(int level);
  /** Return the number of iterations on the level. */
  int Iterations() const { return this->OfLevel; }

  void BeginSweep(int vertices, int eulerCharacteristic);
  /** Append the rows of a finished sweep. They share its seconds; the first row has those before.
   */
  void EndSweep(SweptRows& swept, const SurfaceNumbers& after);
  /** Set the last row to the numbers of the final surface. */
  void Finish(const SurfaceNumbers& regularised);

  /** Add the seconds until now to the last row, at the end of a level. */
  void EndLevel();

private:
  double Lap();

  int Level = 0;
  int OfLevel = 0;
  int Vertices = 0;            ///< before the last sweep
  int EulerCharacteristic = 0; ///< before the last sweep
  double SecondsBefore = 0.;   ///< before the last sweep
  Clock::time_point LastLap = Clock::now();
};
}

#endif

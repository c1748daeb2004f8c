// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionHistory.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace volumic
{
void HistoryRow::Add(const EditCounts& counts)
{
  this->Merges += counts.Merges;
  this->Cuts += counts.Cuts;
  this->Splits += counts.Splits;
  this->Collapses += counts.Collapses;
  this->Flips += counts.Flips;
}

void HistoryRow::Add(const HistoryRow& row)
{
  this->Add(EditCounts{ row.Merges, row.Cuts, row.Splits, row.Collapses, row.Flips });
  this->Vertices += row.Vertices;
  this->EulerCharacteristic += row.EulerCharacteristic;
  this->ActiveVertices += row.ActiveVertices;
  this->TimeStep = std::max(this->TimeStep, row.TimeStep);
}

SweptRows::SweptRows(int iterations, int blocks)
  : Rows(static_cast<std::size_t>(iterations)),
    KineticEnergy(this->Rows.size(), std::vector<double>(static_cast<std::size_t>(blocks), 0.))
{
}

void SweptRows::Add(int block, const std::vector<HistoryRow>& rows)
{
  const std::lock_guard<std::mutex> lock(this->Adding);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    this->Rows[i].Add(rows[i]);
    this->KineticEnergy[i][static_cast<std::size_t>(block)] = rows[i].KineticEnergy;
  }
}

double EvolutionHistory::Lap()
{
  const Clock::time_point now = Clock::now();
  return std::chrono::duration<double>(now - std::exchange(this->LastLap, now)).count();
}

void EvolutionHistory::BeginLevel(int level)
{
  this->Level = level;
  this->OfLevel = 0;
}

void EvolutionHistory::BeginSweep(int vertices, int eulerCharacteristic)
{
  this->Vertices = vertices;
  this->EulerCharacteristic = eulerCharacteristic;
  this->SecondsBefore = this->Lap();
}

void EvolutionHistory::EndSweep(SweptRows& swept, const SurfaceNumbers& after)
{
  // Sum the changes of all blocks in the same iteration.
  const double seconds = this->Lap() / static_cast<double>(swept.Rows.size());
  for (std::size_t i = 0; i < swept.Rows.size(); ++i)
  {
    HistoryRow& row = swept.Rows[i];
    row.Vertices = this->Vertices += row.Vertices;
    row.EulerCharacteristic = this->EulerCharacteristic += row.EulerCharacteristic;
    if (i + 1 == swept.Rows.size())
    {
      row.Vertices = after.Vertices; // Components may have been deleted after the last pass.
      row.EulerCharacteristic = after.EulerCharacteristic;
    }
    row.Iteration = static_cast<int>(this->Rows.size()) + 1;
    row.Level = this->Level;
    row.Components = after.Components;
    row.MeanEdgeLength = after.MeanEdgeLength;
    const std::vector<double>& energy = swept.KineticEnergy[i];
    row.KineticEnergy =
      std::accumulate(energy.begin(), energy.end(), 0.) / std::max(row.Vertices, 1);
    row.Seconds = seconds + std::exchange(this->SecondsBefore, 0.);
    this->Rows.push_back(row);
  }
  this->OfLevel += static_cast<int>(swept.Rows.size());
}

void EvolutionHistory::Finish(const SurfaceNumbers& regularised)
{
  if (this->OfLevel > 0)
  {
    HistoryRow& last = this->Rows.back();
    last.Vertices = regularised.Vertices;
    last.EulerCharacteristic = regularised.EulerCharacteristic;
    last.Components = regularised.Components;
    last.MeanEdgeLength = regularised.MeanEdgeLength;
  }
}

void EvolutionHistory::EndLevel()
{
  if (this->OfLevel > 0)
  {
    this->Rows.back().Seconds += this->Lap();
  }
}
}

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
  this->Deletions += counts.Removed;
  this->DeletedGenus += counts.RemovedGenus;
}

void HistoryRow::Add(const HistoryRow& row)
{
  this->Add(EditCounts{
    row.Merges, row.Cuts, row.Splits, row.Collapses, row.Flips, row.Deletions, row.DeletedGenus });
  this->Vertices += row.Vertices;
  this->EulerCharacteristic += row.EulerCharacteristic;
  this->ActiveVertices += row.ActiveVertices;
  this->TimeStep = std::max(this->TimeStep, row.TimeStep);
  for (std::size_t i = 0; i < this->PhaseSeconds.size(); ++i)
  {
    this->PhaseSeconds[i] += row.PhaseSeconds[i];
  }
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
  this->Pending.Recovered = 0;
  this->Afterwards = EditCounts();
}

void EvolutionHistory::BeginSweep(int vertices, int eulerCharacteristic)
{
  this->Vertices = vertices;
  this->EulerCharacteristic = eulerCharacteristic;
  this->SecondsBefore = this->Lap();
}

void EvolutionHistory::EndSweep(SweptRows& swept, const SurfaceNumbers& after)
{
  // As if all blocks had been in the same iteration: what has changed in each, added up. The
  // seconds are shared out as the threads that make the visits have spent them.
  const double seconds = this->Lap();
  HistoryRow& first = swept.Rows.front();
  first.SecondsBefore = this->SecondsBefore;
  first.AddedEulerCharacteristic =
    this->EulerCharacteristic - (this->Rows.empty() ? 0 : this->Rows.back().EulerCharacteristic);
  double spent = 0.;
  for (const HistoryRow& row : swept.Rows)
  {
    spent = std::accumulate(row.PhaseSeconds.begin(), row.PhaseSeconds.end(), spent);
  }
  for (std::size_t i = 0; i < swept.Rows.size(); ++i)
  {
    HistoryRow& row = swept.Rows[i];
    row.Vertices = this->Vertices += row.Vertices;
    row.EulerCharacteristic = this->EulerCharacteristic += row.EulerCharacteristic;
    if (i + 1 == swept.Rows.size())
    {
      row.Vertices = after.Vertices; // Components may have been deleted after the last visit.
      row.EulerCharacteristic = after.EulerCharacteristic;
    }
    row.IterationVertices = row.Vertices;
    row.IterationEulerCharacteristic = row.EulerCharacteristic;
    row.Iteration = static_cast<int>(this->Rows.size()) + 1;
    row.Level = this->Level;
    row.Components = row.IterationComponents = after.Components;
    row.MeanEdgeLength = row.IterationMeanEdgeLength = after.MeanEdgeLength;
    const std::vector<double>& energy = swept.KineticEnergy[i];
    row.KineticEnergy =
      std::accumulate(energy.begin(), energy.end(), 0.) / std::max(row.Vertices, 1);
    row.Seconds = spent > 0. ? 0. : seconds / static_cast<double>(swept.Rows.size());
    for (double& ofPhase : row.PhaseSeconds)
    {
      ofPhase *= spent > 0. ? seconds / spent : 0.;
      row.Seconds += ofPhase;
    }
    if (this->OfLevel++ == 0)
    {
      row.Add(this->Pending);
      row.Recovered = this->Pending.Recovered;
      this->Pending = HistoryRow();
    }
    this->Rows.push_back(row);
  }
  this->Afterwards = EditCounts();
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
    last.RegularisationCuts = this->Afterwards.Cuts;
    last.RegularisationDeletions = this->Afterwards.Removed;
  }
}

void EvolutionHistory::EndLevel()
{
  const double seconds = this->Lap();
  if (this->OfLevel > 0)
  {
    this->Rows.back().SecondsAfter += seconds;
  }
}
}

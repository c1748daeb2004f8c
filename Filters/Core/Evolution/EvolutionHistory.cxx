// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace volumic
{
double SurfaceEvolution::Implementation::Lap()
{
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - this->LastLap).count();
  this->LastLap = now;
  this->LevelSeconds += seconds;
  return seconds;
}

bool SurfaceEvolution::Implementation::HasIteration() const
{
  return this->LastIterations > 0 && !this->Rows.empty();
}

void SurfaceEvolution::Implementation::FillCounts(HistoryRow& row) const
{
  row.Vertices = this->State.Mesh.NumberOfVertices();
  row.EulerCharacteristic = this->State.EulerCharacteristic;
  row.Components = this->NumberOfComponents;
}

void SurfaceEvolution::Implementation::BeginRow(HistoryRow& row)
{
  row.SecondsBefore = this->Lap();
  row.AddedEulerCharacteristic = this->State.EulerCharacteristic -
    (this->Rows.empty() ? 0 : this->Rows.back().EulerCharacteristic);
}

void SurfaceEvolution::Implementation::KeepRow(const HistoryRow& row)
{
  this->Rows.push_back(row);
  if (this->LastIterations == 0)
  {
    HistoryRow& first = this->Rows.back();
    first.Recovered = this->LastLost.Enclosed + this->LastLost.EnclosedCavities;
    for (const Phase phase : { Phase::Division, Phase::Recovery })
    {
      first.PhaseSeconds[static_cast<int>(phase)] =
        this->Preparing.PhaseSeconds[static_cast<int>(phase)];
    }
    this->Preparing = HistoryRow();
  }
  this->SinceEvolved = EditCounts();
  ++this->LastIterations;
}

double SurfaceEvolution::Implementation::MeanEdgeLength() const
{
  const double sum =
    this->Blocks->SumUp([this](int v) { return this->State.EdgeLengthSum[v]; }, this->Threads);
  // Each edge is in two sums.
  const std::int64_t edges =
    NumberOfEdges(this->State.Mesh.NumberOfVertices(), this->State.EulerCharacteristic);
  return edges > 0 ? sum / (2. * static_cast<double>(edges)) : 0.;
}

void SurfaceEvolution::Implementation::FinishRow()
{
  if (!this->HasIteration())
  {
    return;
  }
  HistoryRow& last = this->Rows.back();
  this->FillCounts(last);
  last.MeanEdgeLength = this->MeanEdgeLength();
  last.RegularisationCuts = this->SinceEvolved.Cuts;
  last.RegularisationDeletions = this->SinceEvolved.Removed;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
/** Vertices that one thread sums up at a time. */
constexpr std::size_t SumBlock = 4096;
}

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
  row.Components = this->Iteration.NumberOfComponents();
}

double SurfaceEvolution::Implementation::KineticEnergy() const
{
  const SurfaceState& s = this->State;
  const std::vector<int>& active = this->Iteration.ActiveVertices();
  return SumOfBlocks(this->Threads, active.size(), SumBlock,
    [&](std::size_t begin, std::size_t end)
    {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = active[i];
        const double speed = s.Mesh.IsAlive(v) ? Dot(s.Velocity[v], s.Normal[v].Axis()) : 0.;
        sum += 0.5 * speed * speed;
      }
      return sum;
    });
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
      first.Phases[static_cast<int>(phase)] = this->Preparing.Phases[static_cast<int>(phase)];
    }
    this->Preparing = HistoryRow();
  }
  this->SinceEvolved = EditCounts();
  ++this->LastIterations;
}

void SurfaceEvolution::Implementation::FillRow(HistoryRow& row)
{
  const SurfaceState& s = this->State;
  row.Iteration = static_cast<int>(this->Rows.size()) + 1;
  row.Level = this->Level;
  row.Merges = s.Counts.Merges;
  row.Cuts = s.Counts.Cuts;
  row.Splits = s.Counts.Splits;
  row.Collapses = s.Counts.Collapses;
  row.Flips = s.Counts.Flips;
  row.Deletions = s.Counts.Removed;
  row.DeletedGenus = s.Counts.RemovedGenus;
  this->FillCounts(row);
  row.KineticEnergy = this->KineticEnergy() / std::max(row.Vertices, 1);
  row.MeanEdgeLength = this->MeanEdgeLength();
  row.IterationVertices = row.Vertices;
  row.IterationMeanEdgeLength = row.MeanEdgeLength;
  row.IterationEulerCharacteristic = row.EulerCharacteristic;
  row.IterationComponents = row.Components;
}

double SurfaceEvolution::Implementation::MeanEdgeLength()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  const double sum = this->Blocks
    ? this->SumOfBlocksOf([this](int v) { return this->State.EdgeLengthSum[v]; })
    : SumOfBlocks(this->Threads, mesh.Rings.size(), SumBlock,
        [&](std::size_t begin, std::size_t end)
        {
          double block = 0;
          for (std::size_t v = begin; v < end; ++v)
          {
            block += this->State.EdgeLengthSum[v];
          }
          return block;
        });
  // Each edge is in two sums.
  const std::int64_t edges =
    NumberOfEdges(mesh.NumberOfVertices(), this->State.EulerCharacteristic);
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

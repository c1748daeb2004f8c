// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "EvolutionImplementation.h"
#include "SurfacePolish.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace volumic
{
namespace
{
/** Passes of tangential smoothing and snapping at the end of a level. */
constexpr int RegularisationPasses = 12;
/** Way in a pass, in delta, under which a vertex is left where it is. */
constexpr float SmallestMove = 0.015f;
}

double SurfaceEvolution::Implementation::EnclosedVolume()
{
  // Fixed blocks summed in order; each face is seen from its three corners.
  const SurfaceMesh& mesh = this->State.Mesh;
  constexpr std::size_t size = 2048;
  this->Partial.assign((mesh.Rings.size() + size - 1) / size, 0.);
  const VectorD origin(mesh.Position.front());
  ForBlocks(this->Threads, mesh.Rings.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        const Ring& ring = mesh.Rings[v];
        const VectorD p = VectorD(mesh.Position[v]) - origin;
        VectorD fan;
        for (int i = 0; i < ring.Count; ++i)
        {
          fan += Cross(VectorD(mesh.Position[ring.Item[i]]) - origin,
            VectorD(mesh.Position[ring.Next(i)]) - origin);
        }
        sum += ring.Count > 0 ? Dot(p, fan) : 0.;
      }
      this->Partial[b] = sum;
    });
  double sum = 0;
  for (double x : this->Partial)
  {
    sum += x;
  }
  return sum / 18.;
}

StopReason SurfaceEvolution::Implementation::Evolve()
{
  SurfaceState& s = this->State;
  this->LastIterations = 0;
  this->Rest.Reset();
  Dynamics dynamics(*this->TheField, this->Options, this->Threads);
  const bool evidence = this->Options.IsopotentialWeight > 0;
  Remesher remesher(s, evidence ? this->TheField.get() : nullptr, this->Options.TopologyChanges);
  const double cube = std::pow(static_cast<double>(s.Delta), 3);
  while (true)
  {
    if (s.Mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
    if (this->LastIterations >= this->Options.MaximumNumberOfIterations)
    {
      return StopReason::IterationLimit;
    }
    HistoryRow row;
    this->Iterate(row, dynamics, remesher, Mode::Evolve);
    if (this->LastIterations == 0)
    {
      row.Recovered = this->LastLost.Enclosed + this->LastLost.EnclosedCavities;
      row.PhaseSeconds[static_cast<int>(Phase::Division)] += this->Preparing;
      this->Preparing = 0.;
    }
    this->Rows.push_back(row);
    ++this->LastIterations;
    Monitor::Status status;
    status.Level = this->Level;
    status.Iteration = this->LastIterations;
    status.Vertices = row.Vertices;
    status.ActiveVertices = row.ActiveVertices;
    status.Fraction = 1. - std::exp(-this->LastIterations / 80.);
    if (!this->Listener.Continue(status))
    {
      return StopReason::Cancelled;
    }
    if (this->LastIterations % RestCriterion::Interval == 0 && s.Mesh.NumberOfVertices() > 0)
    {
      const double volume = this->EnclosedVolume();
      this->Rest.Add(volume);
      if (this->Rest.IsMet(
            std::max(cube, this->Options.ConvergenceTolerance * std::abs(volume))))
      {
        return StopReason::Converged;
      }
    }
  }
}

void SurfaceEvolution::Implementation::SleepUnlessMoving(float least)
{
  // What went some way in the last pass stays awake, with its neighbours, and what was edited.
  SurfaceState& s = this->State;
  for (int v : this->Awake)
  {
    if (s.Mesh.IsAlive(v) && s.Quiet[v] > 0 && SquaredLength(s.Velocity[v]) <= least * least)
    {
      s.Awake[v] = 0;
    }
  }
  for (int v : this->Awake)
  {
    if (s.Mesh.IsAlive(v) && SquaredLength(s.Velocity[v]) > least * least)
    {
      const Ring& ring = s.Mesh.Rings[v];
      for (int i = 0; i < ring.Count; ++i)
      {
        s.Awake[ring.Item[i]] = 1;
      }
    }
  }
}

void SurfaceEvolution::Implementation::Regularise(Dynamics& dynamics)
{
  // The same verified displacements and edits, driven by shape and residual instead of forces.
  SurfaceState& s = this->State;
  const std::vector<std::uint8_t> awake = s.Awake;
  Remesher remesher(s, this->TheField.get(), false);
  std::fill(s.Velocity.begin(), s.Velocity.end(), Vector());
  HistoryRow row;
  this->WakeAll();
  for (int pass = 0; pass < RegularisationPasses && s.Mesh.NumberOfVertices() > 0; ++pass)
  {
    if (pass > 0)
    {
      this->SleepUnlessMoving(SmallestMove * s.Delta);
    }
    std::fill(s.Quiet.begin(), s.Quiet.end(), std::uint8_t(1)); // An edit makes it 0 again.
    this->Iterate(row, dynamics, remesher, Mode::Regularise);
  }
  const auto start = std::chrono::steady_clock::now();
  const int cuts = s.Counts.Cuts;
  SurfacePolish(s, this->Options.SnapToIsoValue ? this->TheField.get() : nullptr,
    this->Options.TopologyChanges, this->Threads)
    .Run();
  this->UpdateTouched();
  if (s.Counts.Cuts > cuts)
  {
    this->Watch.Label(s, this->Threads);
    this->Watch.DeleteDoomed(s);
  }
  row.Seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    s.Awake[v] = s.Mesh.IsAlive(v) && (v >= static_cast<int>(awake.size()) || awake[v]);
    s.Velocity[v] = Vector();
  }
  if (!this->Rows.empty())
  {
    HistoryRow& last = this->Rows.back();
    last.PhaseSeconds[static_cast<int>(Phase::Division)] += row.Seconds;
    this->FillCounts(last);
  }
}

StopReason SurfaceEvolution::Implementation::Run()
{
  if (this->Cancelled)
  {
    this->LastIterations = 0;
    return StopReason::Cancelled;
  }
  const StopReason reason = this->Evolve();
  if (reason == StopReason::Converged || reason == StopReason::IterationLimit)
  {
    Dynamics dynamics(*this->TheField, this->Options, this->Threads);
    this->Regularise(dynamics);
    if (this->State.Mesh.NumberOfVertices() == 0)
    {
      return StopReason::Vanished;
    }
  }
  return reason;
}
}

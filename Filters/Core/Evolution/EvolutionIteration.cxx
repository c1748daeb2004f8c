// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EvolutionImplementation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace volumic
{
namespace
{
using Clock = std::chrono::steady_clock;

/** Adds the time since the last call to a phase. */
class Stopwatch
{
public:
  explicit Stopwatch(HistoryRow& row) : Row(row), Start(Clock::now()), Last(Start) {}
  void Lap(Phase phase)
  {
    const Clock::time_point now = Clock::now();
    this->Row.PhaseSeconds[static_cast<int>(phase)] +=
      std::chrono::duration<double>(now - this->Last).count();
    this->Last = now;
  }
  void Stop()
  {
    this->Row.Seconds += std::chrono::duration<double>(Clock::now() - this->Start).count();
  }

private:
  HistoryRow& Row;
  Clock::time_point Start;
  Clock::time_point Last;
};
}

void SurfaceEvolution::Implementation::CollectAwake()
{
  this->Awake.clear();
  for (int v = 0; v < this->State.Mesh.Size(); ++v)
  {
    if (this->State.Awake[v])
    {
      this->Awake.push_back(v);
    }
  }
}

void SurfaceEvolution::Implementation::MarkRing(int v)
{
  const Ring& ring = this->State.Mesh.Rings[v];
  for (int i = 0; i < ring.Count; ++i)
  {
    const int w = ring.Item[i];
    if (!this->Marked[w])
    {
      this->Marked[w] = 1;
      this->Working.push_back(w);
    }
  }
}

void SurfaceEvolution::Implementation::CollectWorking()
{
  // The awake vertices and the corners of all triangles that move with them.
  this->Marked.assign(this->State.Mesh.Rings.size(), 0);
  this->Working = this->Awake;
  for (int v : this->Awake)
  {
    this->Marked[v] = 1;
  }
  for (int v : this->Awake)
  {
    this->MarkRing(v);
  }
  for (std::size_t i = this->Awake.size(); i < this->Working.size(); ++i)
  {
    this->State.Before[this->Working[i]] = this->State.Mesh.Position[this->Working[i]];
  }
}

void SurfaceEvolution::Implementation::CollectSuspects()
{
  // A star that had some room when it was examined needs no new look before it has used half of
  // it: whatever comes near has used half of its own and is examined itself.
  SurfaceState& s = this->State;
  this->Threads.For(this->Working.size(), 1024,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = this->Working[i];
        const Ring& ring = s.Mesh.Rings[v];
        float moved = s.Moved[v];
        for (int k = 0; k < ring.Count; ++k)
        {
          moved = std::max(moved, s.Moved[ring.Item[k]]);
        }
        s.Drift[v] += moved;
        s.Slow[v] = moved < 0.08f * s.Delta;
      }
    });
  this->Suspects.clear();
  for (int v : this->Working)
  {
    if (s.Drift[v] > 0.5f * s.Slack[v])
    {
      s.Drift[v] = 0;
      this->Suspects.push_back(v);
    }
  }
  for (int v : this->Awake)
  {
    s.Moved[v] = 0;
  }
}

void SurfaceEvolution::Implementation::UpdateTouched()
{
  std::vector<int>& touched = this->State.Touched;
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  this->State.UpdateShape(touched, this->Threads);
  for (int v : touched)
  {
    this->State.Drift[v] = 1e6f; // Its star is another one: what was examined tells nothing.
  }
  touched.clear();
}

void SurfaceEvolution::Implementation::RollBack()
{
  // The mesh before the displacement was free of intersections, and so is any mesh all of whose
  // vertices have gone back: take back more and more about each hit until none is left.
  SurfaceState& s = this->State;
  const std::vector<Proximity::Meeting>* meetings = &this->Near.Meetings();
  std::vector<int> back;
  std::vector<int> list;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds && !meetings->empty(); ++round)
  {
    back.clear();
    for (const Proximity::Meeting& meeting : *meetings)
    {
      back.insert(back.end(), meeting.First.begin(), meeting.First.end());
      back.insert(back.end(), meeting.Second.begin(), meeting.Second.end());
    }
    for (int widening = 0; widening < round - 1; ++widening)
    {
      const std::size_t n = back.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        const Ring& ring = s.Mesh.Rings[back[i]];
        back.insert(back.end(), ring.Item, ring.Item + ring.Count);
      }
      std::sort(back.begin(), back.end());
      back.erase(std::unique(back.begin(), back.end()), back.end());
    }
    if (round == rounds - 1)
    {
      back = this->Working; // All that has moved: the mesh before, which was free of them.
    }
    std::sort(back.begin(), back.end());
    back.erase(std::unique(back.begin(), back.end()), back.end());
    list = back;
    for (int v : back)
    {
      // Vertices that are not in the working list have not moved; their Before may be old.
      if (!this->Marked[v])
      {
        continue;
      }
      s.MoveTo(v, s.Before[v]);
      s.Velocity[v] = Vector();
      s.Stuck[v] = static_cast<std::uint8_t>(std::min(s.Stuck[v] + 2, 200));
      s.Awake[v] = 1;
      s.Quiet[v] = 0;
      s.Drift[v] = 1e6f;
      list.insert(list.end(), s.Mesh.Rings[v].Item, s.Mesh.Rings[v].Item + s.Mesh.Rings[v].Count);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    s.UpdateShape(list, this->Threads);
    this->Recheck.Examine(s, list, this->Threads);
    meetings = &this->Recheck.Meetings();
  }
}

void SurfaceEvolution::Implementation::Iterate(
  HistoryRow& row, Dynamics& dynamics, Remesher& remesher, Mode mode)
{
  SurfaceState& s = this->State;
  Stopwatch watch(row);
  s.Counts = EditCounts();
  this->CollectAwake();
  row.ActiveVertices = static_cast<int>(this->Awake.size());
  row.Vertices = s.Mesh.NumberOfVertices();
  const bool relax = mode != Mode::Evolve;
  if (relax)
  {
    dynamics.Relax(
      s, this->Awake, this->Near.Pairs(), mode == Mode::Regularise && this->Options.SnapToIsoValue);
  }
  else
  {
    dynamics.Accelerate(s, this->Awake, this->Near.Pairs());
  }
  row.TimeStep = dynamics.TimeStep();
  watch.Lap(Phase::Forces);

  dynamics.Displace(s, this->Awake);
  this->CollectWorking();
  s.UpdateShape(this->Working, this->Threads);
  watch.Lap(Phase::Contact);

  const std::size_t unsplit = this->Working.size();
  remesher.Split(this->Working);
  this->Marked.resize(s.Mesh.Rings.size(), 0);
  for (std::size_t i = unsplit; i < this->Working.size(); ++i)
  {
    this->Marked[this->Working[i]] = 1; // New, with a place before of its own.
  }
  for (int v : s.Touched)
  {
    if (!this->Marked[v])
    {
      this->Marked[v] = 1;
      s.Before[v] = s.Mesh.Position[v];
      this->Working.push_back(v);
    }
  }
  this->UpdateTouched();
  watch.Lap(Phase::Remeshing);

  this->CollectSuspects();
  this->Near.Examine(s, this->Suspects, this->Threads);
  watch.Lap(Phase::Proximity);
  this->RollBack();
  if (!relax)
  {
    dynamics.Freeze(s, this->Awake, this->Working);
  }
  watch.Lap(Phase::Verification);
  if (mode == Mode::Evolve && !this->GoOn(Monitor::Activity::Iterating, 1.))
  {
    // The surface is free of intersections; a run that ends here needs no edits.
    this->FillRow(row);
    watch.Stop();
    return;
  }

  if (!relax)
  {
    remesher.Merge(this->Near.Pairs());
  }
  watch.Lap(Phase::Topology);
  remesher.Collapse(this->Working);
  remesher.Flip(this->Working);
  remesher.Unstick(this->Working);
  for (int v : this->Working)
  {
    if (s.Stuck[v] > 0)
    {
      --s.Stuck[v];
    }
  }
  // What was rolled back, or drawn back from a cut, may have made edges too long.
  this->Working.insert(this->Working.end(), s.Touched.begin(), s.Touched.end());
  this->UpdateTouched();
  remesher.Split(this->Working);
  this->UpdateTouched();
  watch.Lap(Phase::Remeshing);

  // A component may become a small one without any change of topology.
  this->Shrunk += s.Counts.Collapses;
  constexpr int suspicious = 40;
  // After a merge a small cavity may be a part of the main component, and must not be judged as the
  // cavity it was: labels are made afresh before anything is deleted.
  if (s.Counts.Merges + s.Counts.Cuts > 0 || this->Shrunk > suspicious)
  {
    this->Watch.Label(s, this->Threads);
    this->Shrunk = 0;
  }
  const bool deleted = this->Watch.DeleteDegenerate(s);
  // Only a cut can give birth to one, and what was inside a deleted component is bare.
  this->Unchecked += s.Counts.Cuts + (deleted ? 1 : 0);
  constexpr int period = 10;
  if (this->LastIterations % period == 0 && this->Unchecked > 0)
  {
    this->Watch.DeleteInsideOut(s, this->Threads);
    this->Unchecked = 0;
  }
  watch.Lap(Phase::Topology);
  this->FillRow(row);
  this->SinceEvolved.Cuts += s.Counts.Cuts;
  this->SinceEvolved.Removed += s.Counts.Removed;
  watch.Stop();
}

void SurfaceEvolution::Implementation::FillCounts(HistoryRow& row) const
{
  row.Vertices = this->State.Mesh.NumberOfVertices();
  row.EulerCharacteristic = this->State.EulerCharacteristic;
  row.Components = this->Watch.NumberOfComponents();
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
  constexpr std::size_t size = 4096;
  this->Partial.assign((this->Awake.size() + size - 1) / size, 0.);
  ForBlocks(this->Threads, this->Awake.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = this->Awake[i];
        const double speed = s.Mesh.IsAlive(v) ? Dot(s.Velocity[v], s.Normal[v]) : 0.;
        sum += 0.5 * speed * speed;
      }
      this->Partial[b] = sum;
    });
  row.KineticEnergy =
    std::accumulate(this->Partial.begin(), this->Partial.end(), 0.) / std::max(row.Vertices, 1);
  row.MeanEdgeLength = this->MeanEdgeLength();
  row.IterationVertices = row.Vertices;
  row.IterationMeanEdgeLength = row.MeanEdgeLength;
  row.IterationEulerCharacteristic = row.EulerCharacteristic;
  row.IterationComponents = row.Components;
}

double SurfaceEvolution::Implementation::MeanEdgeLength()
{
  const SurfaceMesh& mesh = this->State.Mesh;
  constexpr std::size_t size = 4096;
  this->Partial.assign((mesh.Rings.size() + size - 1) / size, 0.);
  ForBlocks(this->Threads, mesh.Rings.size(), size,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      double sum = 0;
      for (std::size_t v = begin; v < end; ++v)
      {
        sum += this->State.EdgeSum[v];
      }
      this->Partial[b] = sum;
    });
  // Each edge is in two sums.
  const std::int64_t edges =
    NumberOfEdges(mesh.NumberOfVertices(), this->State.EulerCharacteristic);
  const double sum = std::accumulate(this->Partial.begin(), this->Partial.end(), 0.);
  return edges > 0 ? sum / (2. * static_cast<double>(edges)) : 0.;
}
}

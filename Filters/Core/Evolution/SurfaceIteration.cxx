// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceIteration.h"

#include "Core/Common/Select.h"
#include "Core/Evolution/Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace volumic
{
namespace
{
/** A displacement, in delta, that uses little of a vertex's slack. */
constexpr float SlowDisplacement = 0.08f;
/** Collapses after which a component may have become a small one. */
constexpr int SuspiciousCollapses = 40;
/** Iterations between two looks for components that are inside out. */
constexpr int InsideOutPeriod = 10;
/** Vertices that one thread looks at at a time. */
constexpr std::size_t ActiveGrain = 2048;
constexpr std::size_t ClearedGrain = 1 << 16;
/** Where fewer than one vertex in so many is marked, the marks are cleared one by one. */
constexpr std::size_t SparseMarks = 64;
/** Vertices that FindIntersections examines at a time: what it finds of each takes memory. */
constexpr std::size_t ExaminedPart = 1000000;

void SortUnique(std::vector<int>& vertices)
{
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}
}

void SurfaceIteration::Forget()
{
  this->Near.Clear();
  this->Recheck.Clear();
}

void SurfaceIteration::BeginVisit(const std::vector<int>& vertices, const Box& about)
{
  SurfaceState& s = this->State;
  this->Visited = &vertices;
  this->About = about;
  this->Forget();
  this->CollectActive();
  // The pairs of those that were near others, from when they were examined, are forgotten.
  this->Suspects = SelectOf(this->Threads, this->Active,
    [this, &s](int v) { return s.NearOthers[v] != 0 || this->IsSuspect(v); });
  for (const int v : this->Suspects)
  {
    s.Drift[v] = 0;
  }
  this->Near.Examine(s, this->Suspects, this->Threads);
  this->Label();
}

void SurfaceIteration::EndVisit()
{
  this->Visited = nullptr;
  this->Forget();
}

std::vector<Proximity::FacePair> SurfaceIteration::FindIntersections(
  const std::vector<int>& vertices)
{
  std::vector<Proximity::FacePair> found;
  for (std::size_t begin = 0; begin < vertices.size(); begin += ExaminedPart)
  {
    const std::size_t end = std::min(vertices.size(), begin + ExaminedPart);
    const std::vector<int> part(vertices.begin() + static_cast<std::ptrdiff_t>(begin),
      vertices.begin() + static_cast<std::ptrdiff_t>(end));
    this->Near.Clear();
    this->Near.Examine(this->State, part, this->Threads);
    found.insert(found.end(), this->Near.Intersections().begin(), this->Near.Intersections().end());
  }
  this->Near.Clear();
  return found;
}

void SurfaceIteration::Label()
{
  if (this->Visited)
  {
    this->Watch.LabelSmall(this->State, *this->Visited, this->About);
  }
  else
  {
    this->Watch.Label(this->State, this->Threads);
  }
  this->CollapsesSinceLabels = 0;
}

void SurfaceIteration::CollectActive()
{
  if (this->Visited)
  {
    this->Active = SelectOf(this->Threads, *this->Visited,
      [this](int v) { return this->State.Mesh.IsAlive(v) && this->State.Active[v] != 0; });
    return;
  }
  Select(
    this->Threads, this->State.Mesh.Rings.size(), this->Active,
    [this](std::size_t v) { return this->State.Active[v] != 0; },
    [](std::size_t v) { return static_cast<int>(v); });
}

void SurfaceIteration::UpdateActive()
{
  this->CollectActive();
  this->State.UpdateShape(this->Active, this->Threads);
}

std::vector<int> SurfaceIteration::SplitLongEdges(std::vector<int> vertices)
{
  Remesher remesher(this->State, nullptr, false, this->Threads);
  remesher.Split(vertices);
  this->UpdateChanged(remesher.TakeChanged());
  return vertices;
}

void SurfaceIteration::ClearMarks()
{
  const std::size_t size = this->State.Mesh.Rings.size();
  if (this->Working.size() < this->IsWorking.size() / SparseMarks)
  {
    // Of a block of many: the others' marks are not touched.
    for (const int v : this->Working)
    {
      this->IsWorking[v] = 0;
    }
    this->IsWorking.resize(size, 0);
    return;
  }
  this->IsWorking.resize(size);
  this->Threads.For(this->IsWorking.size(), ClearedGrain,
    [this](std::size_t begin, std::size_t end)
    {
      std::fill(this->IsWorking.begin() + static_cast<std::ptrdiff_t>(begin),
        this->IsWorking.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t(0));
    });
}

void SurfaceIteration::CollectWorking()
{
  // The active vertices and the corners of all faces that move with them.
  SurfaceState& s = this->State;
  this->ClearMarks();
  this->Working.resize(this->Active.size());
  this->Threads.For(this->Active.size(), ActiveGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        this->Working[i] = this->Active[i];
        this->IsWorking[this->Active[i]] = 1;
      }
    });
  std::vector<std::vector<int>> blocks((this->Active.size() + ActiveGrain - 1) / ActiveGrain);
  ForBlocks(this->Threads, this->Active.size(), ActiveGrain,
    [&](std::size_t b, std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Ring& ring = s.Mesh.Rings[this->Active[i]];
        std::copy_if(ring.Item, ring.Item + ring.Count, std::back_inserter(blocks[b]),
          [this](int w) { return !this->IsWorking[w]; });
      }
    });
  std::vector<int> unmoved;
  for (const std::vector<int>& block : blocks)
  {
    unmoved.insert(unmoved.end(), block.begin(), block.end());
  }
  for (int v : unmoved)
  {
    this->AddUnmoved(v);
  }
}

void SurfaceIteration::AddUnmoved(int v)
{
  if (!this->IsWorking[v])
  {
    this->IsWorking[v] = 1;
    this->State.PreviousPosition[v] = this->State.Mesh.Position[v];
    this->Working.push_back(v);
  }
}

bool SurfaceIteration::IsSuspect(int v) const
{
  // A star that had some room when it was examined needs no new look before it has used half of
  // it: whatever comes near has used half of its own and is examined itself.
  return this->State.Drift[v] > 0.5f * this->State.Slack[v];
}

void SurfaceIteration::CollectSuspects()
{
  SurfaceState& s = this->State;
  this->Threads.For(this->Working.size(), 1024,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const int v = this->Working[i];
        const Ring& ring = s.Mesh.Rings[v];
        float moved = s.Displacement[v];
        for (int k = 0; k < ring.Count; ++k)
        {
          moved = std::max(moved, s.Displacement[ring.Item[k]]);
        }
        s.Drift[v] += moved;
        s.IsSlow[v] = moved < SlowDisplacement * s.Sizing.At(v);
      }
    });
  Select(
    this->Threads, this->Working.size(), this->Suspects,
    [this](std::size_t i) { return this->IsSuspect(this->Working[i]); },
    [this](std::size_t i) { return this->Working[i]; });
  this->Threads.For(this->Suspects.size(), ActiveGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        s.Drift[this->Suspects[i]] = 0;
      }
    });
  this->Threads.For(this->Active.size(), ActiveGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        s.Displacement[this->Active[i]] = 0;
      }
    });
}

void SurfaceIteration::UpdateChanged(std::vector<int> changed)
{
  // Each once, in any order.
  LargeVector<float>& drift = this->State.Drift.AsVector();
  for (int v : changed)
  {
    drift[v] = 0;
  }
  std::size_t count = 0;
  for (int v : changed)
  {
    if (drift[v] != SurfaceState::NotExamined)
    {
      drift[v] = SurfaceState::NotExamined; // Its star is another one.
      changed[count++] = v;
    }
  }
  changed.resize(count);
  this->State.UpdateShape(changed, this->Threads);
}

void SurfaceIteration::RollBackVertex(int v)
{
  constexpr int most = 200; // Of what fits into the count.
  SurfaceState& s = this->State;
  s.MoveTo(v, s.PreviousPosition[v]);
  s.Velocity[v] = Vector();
  s.RollbackCount[v] = static_cast<std::uint8_t>(std::min(s.RollbackCount[v] + 2, most));
  s.Activate(v);
  s.Drift[v] = SurfaceState::NotExamined;
}

void SurfaceIteration::RollBack()
{
  // The mesh before the displacement was free of intersections, and so is any mesh all of whose
  // vertices have gone back: roll back more and more about each intersection until none is left.
  SurfaceState& s = this->State;
  const std::vector<Proximity::FacePair>* intersections = &this->Near.Intersections();
  std::vector<int> back;
  std::vector<int> examined;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds && !intersections->empty(); ++round)
  {
    back.clear();
    for (const Proximity::FacePair& pair : *intersections)
    {
      back.insert(back.end(), pair.First.begin(), pair.First.end());
      back.insert(back.end(), pair.Second.begin(), pair.Second.end());
    }
    for (int widening = 0; widening < round - 1; ++widening)
    {
      const std::size_t n = back.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        const Ring& ring = s.Mesh.Rings[back[i]];
        back.insert(back.end(), ring.Item, ring.Item + ring.Count);
      }
      SortUnique(back);
    }
    if (round == rounds - 1)
    {
      back = this->Working; // All that has moved: the mesh before, which was free of them.
    }
    SortUnique(back);
    if (this->Visited)
    {
      // What keeps still need not be examined, and further out there may be nothing to look at.
      back.erase(std::remove_if(back.begin(), back.end(),
                   [this](int v) { return this->IsWorking[v] == 0; }),
        back.end());
    }
    examined = back;
    for (int v : back)
    {
      // Vertices that are not in the working list have not moved; their previous position is old.
      if (this->IsWorking[v])
      {
        this->RollBackVertex(v);
        const Ring& ring = s.Mesh.Rings[v];
        examined.insert(examined.end(), ring.Item, ring.Item + ring.Count);
      }
    }
    SortUnique(examined);
    s.UpdateShape(examined, this->Threads);
    this->Recheck.Examine(s, examined, this->Threads);
    intersections = &this->Recheck.Intersections();
  }
}

void SurfaceIteration::SplitBeforeVerification(Remesher& remesher)
{
  const std::size_t unsplit = this->Working.size();
  remesher.Split(this->Working);
  this->IsWorking.resize(this->State.Mesh.Rings.size(), 0);
  for (std::size_t i = unsplit; i < this->Working.size(); ++i)
  {
    this->IsWorking[this->Working[i]] = 1; // New, with a previous position of its own.
  }
  for (int v : remesher.Changed())
  {
    this->AddUnmoved(v);
  }
  this->UpdateChanged(remesher.TakeChanged());
}

void SurfaceIteration::RestoreConstraints(Remesher& remesher)
{
  SurfaceState& s = this->State;
  remesher.Collapse(this->Working);
  this->Threads.EndPhase("Collapses");
  remesher.Flip(this->Working);
  this->Threads.EndPhase("Flips");
  remesher.Unstick(this->Working);
  this->Threads.EndPhase("Unsticking");
  this->Threads.For(this->Working.size(), ActiveGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        std::uint8_t& count = s.RollbackCount[this->Working[i]];
        count = static_cast<std::uint8_t>(count > 0 ? count - 1 : 0);
      }
    });
  // What was rolled back, or drawn back from a cut, may have made edges too long.
  const std::vector<int>& changed = remesher.Changed();
  this->Working.insert(this->Working.end(), changed.begin(), changed.end());
  this->UpdateChanged(remesher.TakeChanged());
  remesher.Split(this->Working);
  this->UpdateChanged(remesher.TakeChanged());
}

void SurfaceIteration::WatchComponents(int number)
{
  SurfaceState& s = this->State;
  // A component may become a small one without any change of topology.
  this->CollapsesSinceLabels += s.Counts.Collapses;
  // After a merge a small cavity may be a part of the main component, and must not be judged as the
  // cavity it was: labels are made afresh before anything is deleted.
  if (s.Counts.Merges + s.Counts.Cuts > 0 || this->CollapsesSinceLabels > SuspiciousCollapses)
  {
    this->Label();
  }
  const bool deleted = this->Watch.DeleteDegenerate(s);
  // Only a cut can give birth to one, and what was inside a deleted component is bare.
  this->Unchecked += s.Counts.Cuts + (deleted ? 1 : 0);
  if (!this->Visited && number % InsideOutPeriod == 0 && this->Unchecked > 0)
  {
    this->DeleteInsideOut();
  }
}

void SurfaceIteration::DeleteInsideOut()
{
  this->Watch.DeleteInsideOut(this->State, this->Threads);
  this->Unchecked = 0;
}

void SurfaceIteration::Run(HistoryRow& row, Dynamics& dynamics, Remesher& remesher, Mode mode,
  int number, const std::function<bool()>& goOn)
{
  SurfaceState& s = this->State;
  const bool evolves = mode == Mode::Evolve;
  Stopwatch watch(row, this->Threads);
  s.Counts = EditCounts();
  this->CollectActive();
  row.ActiveVertices = static_cast<int>(this->Active.size());
  if (evolves)
  {
    dynamics.Accelerate(s, this->Active, this->Near.Pairs());
  }
  else
  {
    dynamics.Relax(s, this->Active, this->Near.Pairs(), mode == Mode::Regularise);
  }
  row.TimeStep = dynamics.TimeStep();
  watch.Lap(Phase::Forces);

  dynamics.Displace(s, this->Active);
  this->Threads.EndPhase("Displacement");
  this->CollectWorking();
  s.UpdateShape(this->Working, this->Threads);
  watch.Lap(Phase::Contact);

  this->SplitBeforeVerification(remesher);
  watch.Lap(Phase::Remeshing);

  this->CollectSuspects();
  this->Near.Examine(s, this->Suspects, this->Threads);
  watch.Lap(Phase::Proximity);
  this->RollBack();
  this->Threads.EndPhase("Roll back");
  if (evolves)
  {
    dynamics.Freeze(s, this->Active, this->Working);
  }
  watch.Lap(Phase::Verification);
  if (!goOn())
  {
    return; // The surface is free of intersections; a run that ends here needs no edits.
  }

  if (evolves)
  {
    remesher.Merge(this->Near.Pairs());
    this->Threads.EndPhase("Merges");
  }
  watch.Lap(Phase::Topology);
  this->RestoreConstraints(remesher);
  watch.Lap(Phase::Remeshing);
  this->WatchComponents(number);
  watch.Lap(Phase::Topology);
}
}

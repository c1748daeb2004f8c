// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/SurfaceIteration.h"

#include "Core/Common/Select.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace volumic
{
namespace
{
/** A displacement, in delta, that is small relative to the clearance of a vertex. */
constexpr float SlowDisplacement = 0.08f;
/** Number of collapses after which a component may be small. */
constexpr int SuspiciousCollapses = 40;

const Dynamics::Relaxation& RelaxationOf(SurfaceIteration::Mode mode)
{
  switch (mode)
  {
    case SurfaceIteration::Mode::Descend:
      return Dynamics::Descending;
    case SurfaceIteration::Mode::Regularise:
      return Dynamics::Regularising;
    default:
      return Dynamics::Adapting;
  }
}
}

SurfaceIteration::SurfaceIteration(SurfaceState& state, BlockPass& pass, const Field* evidence,
  bool topologyChanges, Executor& threads)
  : State(state), Pass(pass), Threads(threads),
    Edits(state, evidence, topologyChanges, &pass.Context)
{
  SurfaceState& s = this->State;
  this->CollectActive();
  // Vertices that other passes have edited or moved, and vertices with contacts: passes keep no
  // pairs.
  std::vector<int> crowded;
  for (const int v : this->Active)
  {
    if (this->IsDirty(v))
    {
      this->DirtyVertices.push_back(v);
      s.MotionSinceTest[v] = 0;
    }
    else if (s.NearOthers[v])
    {
      crowded.push_back(v);
    }
  }
  this->Near.Test(s, this->DirtyVertices, threads);
  this->Near.AddPairs(s, crowded);
  this->Watch.LabelSmall(s, pass.First, pass.End(), pass.Written, pass.Large);
  this->Labelled = pass.Context.Counts;
}

SurfaceIteration::~SurfaceIteration()
{
  for (const int v : this->Working)
  {
    this->State.Marks[v] = 0;
  }
}

void SurfaceIteration::CollectActive()
{
  // Ends of an edge that is too long do not move until it is split.
  const SurfaceState& s = this->State;
  this->Active.clear();
  for (int v = this->Pass.First; v < this->Pass.End(); ++v)
  {
    if (s.Active[v] != 0 && s.Mesh.IsAlive(v) && !(s.RemeshFlags[v] & HasHugeEdge) &&
      this->Pass.Moving.Contains(s.Mesh.Position[v]))
    {
      this->Active.push_back(v);
    }
  }
}

void SurfaceIteration::CollectWorking()
{
  // The active vertices and all corners of their faces.
  SurfaceState& s = this->State;
  for (const int v : this->Working)
  {
    s.Marks[v] = 0;
  }
  this->Working = this->Active;
  for (const int v : this->Active)
  {
    s.Marks[v] = IsWorking;
  }
  for (const int v : this->Active)
  {
    const Ring& ring = s.Mesh.Rings[v];
    std::for_each(ring.Item, ring.Item + ring.Count, [this](int w) { this->AddUnmoved(w); });
  }
}

void SurfaceIteration::AddUnmoved(int v)
{
  SurfaceState& s = this->State;
  if (!(s.Marks[v] & IsWorking))
  {
    s.Marks[v] |= IsWorking;
    s.PreviousPosition[v] = s.Mesh.Position[v];
    this->Working.push_back(v);
  }
}

bool SurfaceIteration::IsDirty(int v) const
{
  // A star needs no new intersection test until its motion exceeds half of its clearance. A star
  // that comes near has then exceeded half of its own clearance, and is tested itself.
  return this->State.MotionSinceTest[v] > 0.5f * this->State.ClearanceAtTest[v];
}

void SurfaceIteration::CollectDirtyVertices()
{
  SurfaceState& s = this->State;
  this->DirtyVertices.clear();
  for (const int v : this->Working)
  {
    const Ring& ring = s.Mesh.Rings[v];
    float moved = s.Displacement[v];
    for (int k = 0; k < ring.Count; ++k)
    {
      moved = std::max(moved, s.Displacement[ring.Item[k]]);
    }
    s.MotionSinceTest[v] += moved;
    s.IsSlow[v] = moved < SlowDisplacement * s.Sizing.At(v);
    if (this->IsDirty(v))
    {
      this->DirtyVertices.push_back(v);
      s.MotionSinceTest[v] = 0;
    }
  }
  for (const int v : this->Active)
  {
    s.Displacement[v] = 0;
  }
}

void SurfaceIteration::UpdateChanged(SurfaceState& state, std::vector<int> changed)
{
  SortUnique(changed);
  for (const int v : changed)
  {
    if (state.Mesh.IsAlive(v))
    {
      state.MotionSinceTest[v] = SurfaceState::NeverTested; // Its star has changed.
      state.UpdateShape(v);
    }
  }
}

void SurfaceIteration::RollBackVertex(int v)
{
  constexpr int most = 200; // within the range of the counter
  SurfaceState& s = this->State;
  s.MoveTo(v, s.PreviousPosition[v]);
  s.Velocity[v] = Vector();
  s.RollbackCount[v] = static_cast<std::uint8_t>(std::min(s.RollbackCount[v] + 2, most));
  s.Activate(v);
  s.MotionSinceTest[v] = SurfaceState::NeverTested;
}

void SurfaceIteration::RollBack()
{
  // The mesh before the displacement had no intersections. Roll back more and more vertices around
  // each intersection until none is left.
  SurfaceState& s = this->State;
  const std::vector<Proximity::FacePair>* intersections = &this->Near.Intersections();
  std::vector<int> back;
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
      back = this->Working; // All moved vertices: restores the mesh before the displacement.
    }
    SortUnique(back);
    // Vertices that are not in Working have not moved. Their previous positions are outdated.
    back.erase(
      std::remove_if(back.begin(), back.end(), [&s](int v) { return !(s.Marks[v] & IsWorking); }),
      back.end());
    std::vector<int> tested = back;
    for (const int v : back)
    {
      this->RollBackVertex(v);
      const Ring& ring = s.Mesh.Rings[v];
      tested.insert(tested.end(), ring.Item, ring.Item + ring.Count);
    }
    SortUnique(tested);
    s.UpdateShape(tested, OnThisThread());
    this->Recheck.Test(s, tested, OnThisThread());
    this->Recheck.Clear();
    intersections = &this->Recheck.Intersections();
  }
}

void SurfaceIteration::SplitBeforeVerification()
{
  SurfaceState& s = this->State;
  const std::size_t unsplit = this->Working.size();
  this->Edits.Split(this->Working);
  for (std::size_t i = unsplit; i < this->Working.size(); ++i)
  {
    s.Marks[this->Working[i]] |= IsWorking; // A new vertex has a previous position, too.
  }
  for (const int v : this->Edits.Changed())
  {
    this->AddUnmoved(v);
  }
  UpdateChanged(s, this->Edits.TakeChanged());
  // Edges that could not be split must not grow, because verification requires legal edges. The
  // rollback of a vertex may make an edge to another moved vertex too long.
  std::vector<int> stars;
  do
  {
    stars.clear();
    for (const int v : this->Active)
    {
      if (s.Mesh.IsAlive(v) && (s.RemeshFlags[v] & HasLongEdge) &&
        SquaredDistance(s.Mesh.Position[v], s.PreviousPosition[v]) > 0.f)
      {
        this->RollBackVertex(v);
        const Ring& ring = s.Mesh.Rings[v];
        stars.push_back(v);
        stars.insert(stars.end(), ring.Item, ring.Item + ring.Count);
      }
    }
    SortUnique(stars);
    s.UpdateShape(stars, OnThisThread());
  } while (!stars.empty());
}

void SurfaceIteration::RestoreConstraints()
{
  SurfaceState& s = this->State;
  this->Edits.Collapse(this->Working);
  this->Edits.Flip(this->Working);
  this->Edits.Unstick(this->Working);
  for (const int v : this->Working)
  {
    std::uint8_t& count = s.RollbackCount[v];
    count = static_cast<std::uint8_t>(count > 0 ? count - 1 : 0);
  }
  // Rollbacks and cuts may have made edges too long.
  const std::vector<int>& changed = this->Edits.Changed();
  this->Working.insert(this->Working.end(), changed.begin(), changed.end());
  UpdateChanged(s, this->Edits.TakeChanged());
  this->Edits.Split(this->Working);
  UpdateChanged(s, this->Edits.TakeChanged());
}

void SurfaceIteration::WatchComponents()
{
  // A component may become small without a change of topology. After a merge, a small cavity may be
  // part of the main component. Therefore components are labelled again before any deletion.
  EditContext& context = this->Pass.Context;
  const EditCounts& then = this->Labelled;
  if (context.Counts.Merges + context.Counts.Cuts > then.Merges + then.Cuts ||
    context.Counts.Collapses > then.Collapses + SuspiciousCollapses)
  {
    this->Watch.LabelSmall(this->State, this->Pass.First, this->Pass.End(), this->Pass.Written,
      this->Pass.Large.After(context.Counts));
    this->Labelled = context.Counts;
  }
  this->Watch.DeleteDegenerate(this->State, &context);
}

double SurfaceIteration::KineticEnergy() const
{
  const SurfaceState& s = this->State;
  double sum = 0;
  for (const int v : this->Active)
  {
    const double speed = s.Mesh.IsAlive(v) ? Dot(s.Velocity[v], s.Normal[v].Axis()) : 0.;
    sum += 0.5 * speed * speed;
  }
  return sum;
}

HistoryRow SurfaceIteration::Run(const Dynamics& dynamics, Mode mode)
{
  SurfaceState& s = this->State;
  EditContext& context = this->Pass.Context;
  const EditCounts counts = context.Counts;
  const int added = context.Slots.Added;
  const int characteristic = context.EulerCharacteristic;
  HistoryRow row;
  this->CollectActive();
  row.ActiveVertices = static_cast<int>(this->Active.size());
  this->Move(dynamics, mode);
  row.TimeStep = this->Step.Time;

  if (mode == Mode::Evolve)
  {
    this->Edits.Merge(this->Near.Pairs());
  }
  this->RestoreConstraints();
  this->WatchComponents();
  assert(std::all_of(this->Working.begin(), this->Working.end(),
    [this, &s](int v)
    { return !s.Mesh.IsAlive(v) || this->Pass.Written.Contains(s.Mesh.Position[v]); }));

  row.Add(context.Counts - counts);
  row.Vertices = context.Slots.Added - added;
  row.EulerCharacteristic = context.EulerCharacteristic - characteristic;
  row.KineticEnergy = this->KineticEnergy();
  return row;
}

void SurfaceIteration::Move(const Dynamics& dynamics, Mode mode)
{
  SurfaceState& s = this->State;
  const bool evolves = mode == Mode::Evolve;
  if (evolves)
  {
    dynamics.Accelerate(s, this->Active, this->Near.Pairs(), this->Step, this->Threads);
  }
  else
  {
    dynamics.Relax(
      s, this->Active, this->Near.Pairs(), RelaxationOf(mode), this->Step, this->Threads);
  }

  dynamics.Displace(s, this->Active, this->Step);
  this->CollectWorking();
  s.UpdateShape(this->Working, this->Threads);

  this->SplitBeforeVerification();

  this->CollectDirtyVertices();
  this->Near.Test(s, this->DirtyVertices, this->Threads);
  this->RollBack();
  if (evolves)
  {
    dynamics.Freeze(s, this->Active, this->Working);
  }
}
}

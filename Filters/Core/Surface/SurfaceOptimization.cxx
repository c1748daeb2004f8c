// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfaceOptimization.h"

#include "Core/Common/Select.h"
#include "Core/Surface/StarImprovement.h"
#include "Core/Surface/StarScore.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace volumic
{
namespace
{
constexpr int Rounds = 8;
constexpr int SeparatingRounds = 4;
}

int SurfaceOptimization::NextVertex() const
{
  return this->Context ? this->Context->Slots.Next : this->State.Mesh.Size();
}

std::vector<int> SurfaceOptimization::AliveVertices() const
{
  const SurfaceState& s = this->State;
  std::vector<int> alive;
  std::copy_if(this->Candidates.begin(), this->Candidates.end(), std::back_inserter(alive),
    [&s](int v) { return s.Mesh.IsAlive(v); });
  for (int v = this->FirstNew; v < this->NextVertex(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      alive.push_back(v);
    }
  }
  return alive;
}

void SurfaceOptimization::SeparateAll()
{
  SurfaceState& s = this->State;
  std::vector<int> crowded = this->AliveVertices();
  crowded.erase(
    std::remove_if(crowded.begin(), crowded.end(), [&s](int v) { return s.NearOthers[v] == 0; }),
    crowded.end());
  bool isDone = crowded.empty();
  for (int round = 0; round < SeparatingRounds && !isDone; ++round)
  {
    isDone = true;
    for (const int v : crowded)
    {
      if (SquaredLength(PushAt(s, v)) > 0)
      {
        isDone = !StarImprovement(s, this->Editor, this->SnapTo, false).Separate(v) && isDone;
      }
    }
  }
}

int SurfaceOptimization::ImproveAll(float good, bool mayCut)
{
  SurfaceState& s = this->State;
  const auto score = [&s](int v)
  { return s.Mesh.IsAlive(v) ? StarScore(s, v, s.Mesh.Position[v]) : 1.f; };
  const int characteristic = this->Editor.EulerCharacteristic();
  std::vector<int> list = this->AliveVertices();
  std::vector<int> poor;
  for (int round = 0; round < Rounds && !list.empty(); ++round)
  {
    const auto edited = static_cast<std::ptrdiff_t>(this->Editor.Changed().size());
    std::vector<int> again;
    for (const int v : list)
    {
      const float now = score(v);
      if (now < GoodStar)
      {
        poor.push_back(v);
      }
      if (now < good && !StarImprovement(s, this->Editor, this->SnapTo, mayCut).Improve(v) &&
        now < BadStar)
      {
        again.push_back(v); // An edit of a neighbour may help.
      }
    }
    const std::vector<int>& changed = this->Editor.Changed();
    again.insert(again.end(), changed.begin() + edited, changed.end());
    SortUnique(again);
    list.swap(again);
  }
  // Scores of other stars do not change until these are edited.
  poor.insert(poor.end(), this->Editor.Changed().begin(), this->Editor.Changed().end());
  SortUnique(poor);
  std::vector<int> candidates;
  std::set_intersection(this->Candidates.begin(), this->Candidates.end(), poor.begin(), poor.end(),
    std::back_inserter(candidates));
  this->Candidates.swap(candidates);
  return (this->Editor.EulerCharacteristic() - characteristic) / 2;
}

void SurfaceOptimization::Run(const std::vector<int>& vertices)
{
  this->Candidates = vertices;
  this->FirstNew = this->NextVertex();
  // A collapse may violate the clearance, and a push may make ill-shaped faces.
  this->SeparateAll();
  this->ImproveAll(GoodStar, false);
  this->SeparateAll();
  // Retry the remaining stars. If this fails, a 3-cycle blocks them.
  this->ImproveAll(BadStar, false);
  if (this->ImproveAll(0.f, this->TopologyChanges) > 0)
  {
    this->SeparateAll(); // Both sides of a cut are near each other.
    this->ImproveAll(BadStar, this->TopologyChanges);
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/SurfacePolish.h"

#include "Core/Common/Select.h"
#include "Core/Surface/StarImprovement.h"
#include "Core/Surface/StarScore.h"

#include <algorithm>

namespace volumic
{
namespace
{
constexpr int Rounds = 8;
constexpr int SeparatingRounds = 4;
/** Of the few cuts that a cell may need, three each; what finds none waits for a next round. */
constexpr std::size_t PlacesForCuts = 12;
}

std::vector<int> SurfacePolish::AliveOnes() const
{
  const SurfaceState& s = this->State;
  if (!this->Within)
  {
    return SelectIndices(this->Threads, s.Mesh.Rings.size(),
      [&s](std::size_t v) { return s.Mesh.IsAlive(static_cast<int>(v)); });
  }
  std::vector<int> alive =
    SelectOf(this->Threads, *this->Within, [&s](int v) { return s.Mesh.IsAlive(v); });
  // And what cuts have made.
  for (const int v : this->Cells.Changed())
  {
    if (s.Mesh.IsAlive(v) && s.Block[v] == NoBlock)
    {
      alive.push_back(v);
    }
  }
  std::sort(alive.begin(), alive.end());
  alive.erase(std::unique(alive.begin(), alive.end()), alive.end());
  return alive;
}

void SurfacePolish::SeparateAll()
{
  if (this->Stopped)
  {
    return;
  }
  SurfaceState& s = this->State;
  const std::vector<int> crowded =
    SelectOf(this->Threads, this->AliveOnes(), [&s](int v) { return s.NearOthers[v] != 0; });
  EditCells::Pass pass;
  pass.GoOn = [this] { return !this->IsToStop(); };
  pass.Visit = [this](SurfaceEditor& editor, int v, EditCells::Lists&)
  { StarImprovement(this->State, editor, this->SnapTo, false).Separate(v); };
  for (int round = 0; round < SeparatingRounds && !this->IsToStop(); ++round)
  {
    pass.Items = SelectOf(
      this->Threads, crowded, [&s](int v) { return SquaredLength(PushAt(s, v)) > 0; });
    this->Cells.Run(pass);
  }
}

void SurfacePolish::ImproveAll(float good)
{
  const SurfaceState& s = this->State;
  const auto score = [&s](int v)
  { return s.Mesh.IsAlive(v) ? StarScore(s, v, s.Mesh.Position[v]) : 1.f; };
  EditCells::Pass pass;
  pass.PlacesPerCell = this->MayCut ? PlacesForCuts : 0;
  pass.GoOn = [this] { return !this->IsToStop(); };
  pass.Visit = [this, &score, good](SurfaceEditor& editor, int v, EditCells::Lists& lists)
  {
    // An edit beside it may have changed what was found.
    const float now = score(v);
    if (now < good &&
      !StarImprovement(this->State, editor, this->SnapTo, this->MayCut).Improve(v) &&
      now < BadStar)
    {
      lists.Kept.push_back(v); // What is edited next to it may help.
    }
  };
  std::vector<int> list = this->AliveOnes();
  for (int round = 0; round < Rounds && !list.empty() && !this->IsToStop(); ++round)
  {
    const auto edited = static_cast<std::ptrdiff_t>(this->Cells.Changed().size());
    pass.Items = SelectOf(this->Threads, list, [&](int v) { return score(v) < good; });
    this->Cells.Run(pass);
    list = this->Cells.Kept();
    list.insert(list.end(), this->Cells.Changed().begin() + edited, this->Cells.Changed().end());
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

bool SurfacePolish::IsToStop()
{
  this->Stopped = this->Stopped || !this->Goes(this->Done);
  return this->Stopped;
}

void SurfacePolish::Run(const std::vector<int>& vertices)
{
  this->Within = &vertices;
  this->Run();
  this->Within = nullptr;
}

void SurfacePolish::Run()
{
  // A collapse may bring together what is far apart on the surface, and what is pushed apart may
  // get ill-shaped faces.
  this->SeparateAll();
  this->Done = 0.1;
  this->ImproveAll(GoodStar);
  this->Done = 0.7;
  this->SeparateAll();
  this->Done = 0.8;
  // What could not be mended before may be now; if not, a cycle of three stands in the way.
  this->ImproveAll(BadStar);
  const int cuts = this->State.Counts.Cuts;
  this->MayCut = this->TopologyChanges;
  this->Done = 0.9;
  this->ImproveAll(0.f);
  if (this->State.Counts.Cuts > cuts)
  {
    this->SeparateAll(); // The two sides of a cut are near each other.
    this->ImproveAll(BadStar);
  }
}
}

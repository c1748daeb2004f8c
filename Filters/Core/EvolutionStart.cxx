// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Division.h"
#include "EdgeFlip.h"
#include "EdgeSplit.h"
#include "EvolutionImplementation.h"
#include "InitialSurface.h"
#include "LostParts.h"

#include <algorithm>

namespace volumic
{
void SurfaceEvolution::Implementation::Enter(const LevelImage& image, int level)
{
  this->TheField = std::make_unique<Field>(image, this->Options, this->Threads);
  this->Level = level;
  this->State.Delta = static_cast<float>(this->Options.SamplingRatio * image.Unit);
}

void SurfaceEvolution::Implementation::Reset()
{
  SurfaceState& s = this->State;
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Delta));
  this->LayGrid();
  this->SplitLongEdges();
  this->Near.Examine(s, this->Awake, this->Threads);
  this->Watch.Label(s, this->Threads);
}

void SurfaceEvolution::Implementation::SplitLongEdges()
{
  // Verification relies on it that no edge is longer than the constraints allow.
  SurfaceState& s = this->State;
  this->CollectAwake();
  s.UpdateShape(this->Awake, this->Threads);
  Remesher(s, nullptr, false).Split(this->Awake);
  this->UpdateTouched();
}

void SurfaceEvolution::Implementation::LayGrid()
{
  SurfaceState& s = this->State;
  const LevelImage& image = this->TheField->Image();
  Vector low(0, 0, 0);
  Vector high(static_cast<float>(image.Size[0] * image.Step[0]),
    static_cast<float>(image.Size[1] * image.Step[1]),
    static_cast<float>(image.Size[2] * image.Step[2]));
  for (const Vector& p : s.Mesh.Position)
  {
    low = Vector(std::min(low.X, p.X), std::min(low.Y, p.Y), std::min(low.Z, p.Z));
    high = Vector(std::max(high.X, p.X), std::max(high.Y, p.Y), std::max(high.Z, p.Z));
  }
  const Vector margin(2 * s.Delta, 2 * s.Delta, 2 * s.Delta);
  this->Near.Clear();
  this->Recheck.Clear();
  s.Reset(low - margin, high + margin);
}

void SurfaceEvolution::Implementation::DivideOnce()
{
  SurfaceState& s = this->State;
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Delta));
  const int firstNew = volumic::Divide(s.Mesh);
  // The division flips edges of the old surface; in narrow places these may pass through each
  // other. Such edges are flipped back, which at worst leaves the old surface, and cut to length.
  constexpr int rounds = 8;
  this->LayGrid();
  this->CollectAwake();
  s.UpdateShape(this->Awake, this->Threads);
  this->Near.Examine(s, this->Awake, this->Threads);
  for (int round = 0; round < rounds && !this->Near.Meetings().empty(); ++round)
  {
    std::vector<int> halves;
    for (const Proximity::Meeting& meeting : this->Near.Meetings())
    {
      for (const std::array<int, 3>& face : { meeting.First, meeting.Second })
      {
        for (int k = 0; k < 3; ++k)
        {
          const int a = face[k];
          const int b = face[(k + 1) % 3];
          if (a < firstNew || b < firstNew || !s.Mesh.AreNeighbours(a, b))
          {
            continue;
          }
          const EdgeFlip flip = EdgeFlip::Of(s.Mesh, a, b);
          if (flip.A < firstNew && flip.B < firstNew && flip.IsLegal(s.Mesh))
          {
            flip.Apply(s.Mesh);
            const EdgeSplit split{ flip.A, flip.B };
            const Vector middle =
              (s.Mesh.Position[flip.A] + s.Mesh.Position[flip.B]) * 0.5f;
            const int m = split.IsLegal(s.Mesh) ? split.Apply(s.Mesh, middle) : -1;
            if (m >= 0)
            {
              s.Adopt(m, flip.A);
            }
          }
        }
      }
    }
    this->CollectAwake();
    s.UpdateShape(this->Awake, this->Threads);
    this->Near.Examine(s, this->Awake, this->Threads);
  }
}

void SurfaceEvolution::Implementation::WakeAll()
{
  for (int v = 0; v < this->State.Mesh.Size(); ++v)
  {
    this->State.Awake[v] = this->State.Mesh.IsAlive(v);
  }
}

void SurfaceEvolution::Implementation::Recover()
{
  this->LastLost = LostParts();
  // Without an isopotential there is no object's side to look for.
  if (!(this->Options.IsopotentialWeight > 0.))
  {
    return;
  }
  const bool recovers = this->Options.RecoverLostParts;
  const auto find = [this](PartKind kind)
  {
    return FindLostParts(
      this->State, *this->TheField, kind, this->Options.MinimumPartSize, this->Threads);
  };
  const LostPartCover objects = find(PartKind::Object);
  this->LastLost.Found = objects.Found;
  this->LastLost.Enclosed = recovers ? objects.Covered : 0;
  LostPartCover cavities;
  if (recovers && this->Options.RecoverCavities)
  {
    cavities = find(PartKind::Cavity);
    this->LastLost.FoundCavities = cavities.Found;
    this->LastLost.EnclosedCavities = cavities.Covered;
  }
  if (this->LastLost.Enclosed > 0)
  {
    this->State.Mesh.Append(objects.Surface);
  }
  if (this->LastLost.EnclosedCavities > 0)
  {
    this->State.Mesh.Append(cavities.Surface);
  }
}
}

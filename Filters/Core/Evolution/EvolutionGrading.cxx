// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// A surface is divided only where it is asked for, and where it rests gets longer edges as far as a
// tolerance allows; in the same visits, with the same verified displacements and edits as everything
// else.

#include "Core/Common/Select.h"
#include "Core/Evolution/EvolutionImplementation.h"
#include "Core/Evolution/GradedSizes.h"
#include "Core/Image/VoxelNumbers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
/**
 * By what the sizes may grow at most, round by round: what is measured tells little of edges many
 * times as long. A round takes as long as the whole regularisation.
 */
constexpr float Growths[] = { 2.5f, 1.5f, 1.1f };
/** Passes in each block after the sizes have changed. */
constexpr int Passes = 2;
/** Where more than this share of a surface asks for division all of it is divided: that is faster. */
constexpr double MostDivided = 0.5;
/** Of a division's progress, once it is known where it is wanted. */
constexpr double HalfDivided = 0.5;
}

void SurfaceEvolution::Implementation::ApplySizes(
  const std::vector<int>& changed, const BlockVisits& visits)
{
  // What is known of a star that has another size now was found within another reach.
  SurfaceState& s = this->State;
  std::vector<int> stars;
  for (const int v : changed)
  {
    const Ring& ring = s.Mesh.Rings[v];
    stars.push_back(v);
    stars.insert(stars.end(), ring.Item, ring.Item + ring.Count);
  }
  SortUnique(stars);
  for (const int v : stars)
  {
    s.Active[v] = 1;
    s.Drift[v] = SurfaceState::NotExamined;
  }
  s.UpdateShape(stars, this->Threads);
  if (this->HasEdgeTooLong())
  {
    this->SplitLongEdges(visits);
  }
}

bool SurfaceEvolution::Implementation::DivideWhereWanted(double delta)
{
  SurfaceState& s = this->State;
  this->ForgetBlocks();
  s.Mesh.Reorder(
    SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), this->Threads), this->Threads);
  // Most of it is to keep the edges that it has: so large are the cells of the grid, too.
  const SizingField fine = s.Sizing;
  s.Sizing = SizingField(static_cast<float>(delta));
  this->LayGrid();
  s.Sizing = fine;
  GradedSizes sizes(s, *this->TheField, this->WantedGrading, this->Threads);
  sizes.Begin(static_cast<float>(delta));
  s.UpdateShape(this->AliveVertices(), this->Threads);
  const std::vector<int> divided = sizes.Refine();
  if (this->WantedGrading.HasTolerance() &&
    static_cast<double>(divided.size()) > MostDivided * s.Mesh.NumberOfVertices())
  {
    s.Sizing = SizingField(s.Sizing.OfLevel());
    return false;
  }
  // The mesh stays: what is to have shorter edges is split.
  this->MakeBlocks();
  BlockVisits visits;
  visits.Doing = Monitor::Activity::Dividing;
  visits.From = visits.To = HalfDivided;
  if (this->GoOn(visits.Doing, HalfDivided))
  {
    this->ApplySizes(divided, visits);
  }
  this->LabelComponents();
  return true;
}

void SurfaceEvolution::Implementation::DivideNear(const LostBoundary& lost)
{
  const LevelImage& image = this->TheField->Image();
  const VoxelNumbers numbers(image.Size);
  std::vector<Vector> places;
  for (const std::int64_t voxel : lost.Voxels())
  {
    const std::array<int, 3> index = numbers.PlaceOf(voxel);
    places.emplace_back(static_cast<float>(index[0] * image.Step[0]),
      static_cast<float>(index[1] * image.Step[1]), static_cast<float>(index[2] * image.Step[2]));
  }
  GradedSizes sizes(this->State, *this->TheField, this->WantedGrading, this->Threads);
  BlockVisits visits;
  visits.IsAsked = false;
  this->ApplySizes(sizes.ShrinkNear(places), visits);
}

void SurfaceEvolution::Implementation::Grade(const Dynamics& dynamics)
{
  SurfaceState& s = this->State;
  GradedSizes sizes(s, *this->TheField, this->WantedGrading, this->Threads);
  if (!s.Sizing.IsGraded())
  {
    sizes.Begin(s.Sizing.OfLevel());
  }
  sizes.Widen();
  this->MakeBlocks(); // Wider ones: their bounds are in the largest delta.
  this->LabelComponents();
  for (const int v : this->AliveVertices())
  {
    s.WasActive[v] = s.Active[v];
    s.Velocity[v] = Vector();
  }
  BlockVisits visits;
  visits.Doing = Monitor::Activity::Regularising;
  visits.To = visits.From;
  for (const float growth : Growths)
  {
    if (!this->GoOn(visits.Doing, visits.To))
    {
      break;
    }
    this->ApplySizes(sizes.Adjust(growth), visits);
    this->VisitAll(SurfaceIteration::Mode::Regularise, dynamics, Passes, visits.Doing,
      visits.From, visits.To);
  }
  for (const int v : this->AliveVertices())
  {
    s.Active[v] = s.WasActive[v];
  }
}
}

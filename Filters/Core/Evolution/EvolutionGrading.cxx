// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

// Local division, and longer edges of a converged surface within a tolerance. Both use the same
// verified displacements and edits in block passes as the evolution.

#include "Core/Common/Select.h"
#include "Core/Evolution/Evolution.h"
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
 * Largest growth of sizes per round, because measurements do not extrapolate to much longer edges.
 * A round takes as long as the whole regularisation.
 */
constexpr float Growths[] = { 2.5f, 1.5f, 1.1f };
/** Passes per block after a change of sizes. */
constexpr int Passes = 2;
/** Above this fraction of vertices, a division of the whole surface is faster. */
constexpr double MostDivided = 0.5;
/** Progress of a local division, after the sizes are known. */
constexpr double HalfDivided = 0.5;

/** @param sweep options of SplitLongEdges() */
void ApplySizes(Evolution& e, const std::vector<int>& changed, const Sweep& sweep)
{
  // Test results of stars with a changed size are for another reach.
  SurfaceState& s = e.State;
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
    s.MotionSinceTest[v] = SurfaceState::NeverTested;
  }
  s.UpdateShape(stars, e.Threads);
  if (HasEdgeTooLong(e))
  {
    SplitLongEdges(e, sweep);
  }
}
}

bool DivideWhereRequested(Evolution& e, double delta)
{
  SurfaceState& s = e.State;
  ForgetBlocks(e);
  s.Mesh.Reorder(SpaceFillingOrder(s.Mesh, s.Sizing.Smallest(), e.Threads), e.Threads);
  // Most edges keep their length, which determines the cell size of the grid.
  const SizingField fine = s.Sizing;
  s.Sizing = SizingField(static_cast<float>(delta));
  LayGrid(e);
  s.Sizing = fine;
  GradedSizes sizes(s, *e.TheField, e.Task.Grading, e.Threads);
  sizes.Begin(static_cast<float>(delta));
  s.UpdateShape(AliveVertices(e), e.Threads);
  const std::vector<int> divided = sizes.Refine();
  if (e.Task.Grading.HasTolerance() &&
    static_cast<double>(divided.size()) > MostDivided * s.Mesh.NumberOfVertices())
  {
    s.Sizing = SizingField(s.Sizing.OfLevel());
    return false;
  }
  // Keep the mesh, and split edges where sizes are smaller.
  MakeBlocks(e);
  if (e.GoOn(Monitor::Activity::Dividing, HalfDivided))
  {
    ApplySizes(e, divided, { Monitor::Activity::Dividing, HalfDivided, HalfDivided });
  }
  LabelComponents(e);
  return true;
}

void DivideNear(Evolution& e, const MissedBoundary& missed)
{
  const LevelImage& image = e.Task.Image;
  const VoxelNumbers numbers(image.Size);
  std::vector<Vector> positions;
  for (const std::int64_t voxel : missed.Voxels())
  {
    const std::array<int, 3> index = numbers.IjkOf(voxel);
    positions.emplace_back(static_cast<float>(index[0] * image.Step[0]),
      static_cast<float>(index[1] * image.Step[1]), static_cast<float>(index[2] * image.Step[2]));
  }
  GradedSizes sizes(e.State, *e.TheField, e.Task.Grading, e.Threads);
  Sweep sweep;
  sweep.IsMonitored = false;
  ApplySizes(e, sizes.ShrinkNear(positions), sweep);
}

void Grade(Evolution& e)
{
  SurfaceState& s = e.State;
  GradedSizes sizes(s, *e.TheField, e.Task.Grading, e.Threads);
  if (!s.Sizing.IsGraded())
  {
    sizes.Begin(s.Sizing.OfLevel());
  }
  sizes.Widen();
  MakeBlocks(e); // Larger blocks, relative to the largest delta.
  LabelComponents(e);
  for (const int v : AliveVertices(e))
  {
    s.WasActive[v] = s.Active[v];
    s.Velocity[v] = Vector();
  }
  const Sweep sweep{ Monitor::Activity::Regularising, 0., 0. };
  for (const float growth : Growths)
  {
    if (!e.GoOn(sweep.Doing, sweep.To))
    {
      break;
    }
    ApplySizes(e, sizes.Adjust(growth), sweep);
    Relax(e, SurfaceIteration::Mode::Regularise, Passes, sweep);
  }
  for (const int v : AliveVertices(e))
  {
    s.Active[v] = s.WasActive[v];
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Common/Lattice.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Evolution/Evolution.h"
#include "Core/Evolution/InitialSurface.h"
#include "Core/Evolution/LatticeSurface.h"
#include "Core/Mesh/LegalEdges.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
/** Number of points in a grid cell above which searches are too slow. */
constexpr int MaximumPerCell = 60;
/** Tolerance of the longest edge for positions rounded to float. */
constexpr double Rounding = 1.0001;
/** Pitches of the remeshing lattices in delta, in the order of the attempts. */
constexpr float Pitches[] = { 1.1f, 0.9f, 0.7f };
/** Pitch for large surfaces, which is faster. */
constexpr float CoarsePitch = 1.6f;
/** Edge lengths of the remeshed surface, in delta: shorter ones are collapsed, longer ones split.
 */
constexpr float ShortestEdge = 1.3f;
constexpr float LongestEdge = 2.45f;
/** Fraction of its volume that each component must keep in these collapses. */
constexpr double KeptByCollapses = 0.9;
/** Smallest area of a large surface, in delta^2. */
constexpr double LargeArea = 100000.;
/** Fraction of the volume that the remeshed surface must keep. */
constexpr double LeastShareOfVolume = 0.5;
/**
 * Rounds of edits until edge lengths are legal. They end early at less than one split or collapse
 * per this number of vertices.
 */
constexpr int MaximumNumberOfRounds = 40;
/** Iterations per round. */
constexpr int AdaptingPasses = 1;
constexpr int VerticesPerEdit = 1000;
/** Fraction of remeshing in the progress of the start; the rest are the rounds. */
constexpr double ShareOfRemeshing = 0.5;

struct EdgeLengths
{
  double Shortest = std::numeric_limits<double>::max();
  double Longest = 0.;
};

EdgeLengths LengthsOf(const IndexedSurface& surface)
{
  EdgeLengths lengths;
  for (const Triangle& t : surface.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Point& p = surface.Points[t[k]];
      const Point& q = surface.Points[t[(k + 1) % 3]];
      const double length = std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
      lengths.Shortest = std::min(lengths.Shortest, length);
      lengths.Longest = std::max(lengths.Longest, length);
    }
  }
  return lengths;
}

IndexedSurface WithoutUnusedPoints(const IndexedSurface& surface)
{
  IndexedSurface result;
  LargeVector<int> newIndex(surface.Points.size(), -1);
  result.Triangles.reserve(surface.Triangles.size());
  for (Triangle t : surface.Triangles)
  {
    for (int& corner : t)
    {
      if (newIndex[corner] < 0)
      {
        newIndex[corner] = static_cast<int>(result.Points.size());
        result.Points.push_back(surface.Points[corner]);
      }
      corner = newIndex[corner];
    }
    result.Triangles.push_back(t);
  }
  return result;
}

/** Return whether each point has at most the neighbours that fit in a ring. */
bool FitsRings(const IndexedSurface& surface)
{
  LargeVector<int> valence(surface.Points.size(), 0);
  for (const Triangle& t : surface.Triangles)
  {
    for (int corner : t)
    {
      if (++valence[corner] > Ring::Capacity)
      {
        return false;
      }
    }
  }
  return true;
}

/** Return whether a cell of triangle size has too many points for fast searches. */
bool IsTooDense(const IndexedSurface& surface, double delta)
{
  const double cell = SizingField::SearchRadiusInDelta * delta;
  std::unordered_map<std::uint64_t, int> count;
  for (const Point& p : surface.Points)
  {
    const std::uint64_t key =
      LatticeKey(std::llround(p[0] / cell), std::llround(p[1] / cell), std::llround(p[2] / cell));
    if (++count[key] > MaximumPerCell)
    {
      return true;
    }
  }
  return false;
}

struct Topology
{
  int Components = 0;
  int EulerCharacteristic = 0;
  double Area = 0.;
  double Volume = 0.;

  static Topology Of(const IndexedSurface& surface)
  {
    const SurfaceFeatures features = ComputeFeatures(surface);
    return { static_cast<int>(features.Components.size()), features.EulerCharacteristic,
      features.Area, features.Volume };
  }
};

bool IsSound(const IndexedSurface& surface, double delta)
{
  const EdgeLengths lengths = LengthsOf(surface);
  return !surface.Triangles.empty() && lengths.Shortest > 0. &&
    lengths.Longest <= SizingField::LongestEdgeInDelta * Rounding * delta &&
    CountSelfIntersections(surface, 1) == 0;
}

std::vector<double> VolumesOf(const IndexedSurface& surface)
{
  std::vector<double> volumes;
  for (const ComponentFeatures& component : ComputeFeatures(surface).Components)
  {
    volumes.push_back(std::abs(component.Volume));
  }
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

/** Make most edge lengths legal, unless this deletes small components or creates intersections. */
IndexedSurface WithFewerEdges(const IndexedSurface& surface, float delta, Executor& executor)
{
  IndexedSurface result =
    WithLegalEdges(surface, ShortestEdge * delta, LongestEdge * delta, executor);
  const std::vector<double> before = VolumesOf(surface);
  const std::vector<double> after = VolumesOf(result);
  const bool isKept = std::equal(before.begin(), before.end(), after.begin(), after.end(),
    [](double a, double b) { return b > KeptByCollapses * a; });
  return isKept && CountSelfIntersections(result, 1) == 0 ? result : surface;
}

IndexedSurface Remesh(Evolution& e, const IndexedSurface& surface)
{
  // Thin parts may break on one lattice but not on another. Take the mesh with the same components
  // and genus as the input, or else the nearest one.
  const float delta = e.State.Sizing.OfLevel();
  const Topology requested = Topology::Of(surface);
  const bool isLarge = requested.Area > LargeArea * delta * delta;
  IndexedSurface best;
  int least = std::numeric_limits<int>::max();
  int attempt = 0;
  for (const float pitch : Pitches)
  {
    IndexedSurface mesh =
      RemeshOnLattice(surface, (isLarge ? CoarsePitch : pitch) * delta, attempt++, e.Threads,
        e.ProgressCallbackOf(Monitor::Activity::Starting, 0., ShareOfRemeshing));
    if (e.Stopped)
    {
      return {};
    }
    const Topology found = Topology::Of(mesh);
    const int difference = std::abs(found.Components - requested.Components) +
      std::abs(found.EulerCharacteristic - requested.EulerCharacteristic) +
      (found.Volume > LeastShareOfVolume * requested.Volume ? 0 : 1);
    if (difference < least)
    {
      least = difference;
      best = std::move(mesh);
    }
    if (isLarge || least == 0)
    {
      break;
    }
  }
  return WithFewerEdges(best, delta, e.Threads);
}

void Begin(Evolution& e, const IndexedSurface& surface)
{
  ForgetBlocks(e);
  e.State.Mesh.Clear();
  e.State.Mesh.Append(surface);
  Renumber(e);
}

void Adapt(Evolution& e)
{
  // Uses the verified displacements and edits of an iteration until edge lengths are legal.
  for (int round = 0; round < MaximumNumberOfRounds && !e.Stopped; ++round)
  {
    const auto shareAt = [](int done)
    { return ShareOfRemeshing + (1. - ShareOfRemeshing) * done / MaximumNumberOfRounds; };
    ActivateAll(e);
    Relax(e, SurfaceIteration::Mode::Adapt, AdaptingPasses,
      { Monitor::Activity::Starting, shareAt(round), shareAt(round + 1) });
    const EditCounts& counts = e.State.Counts;
    if (counts.Splits + counts.Collapses <= e.State.Mesh.NumberOfVertices() / VerticesPerEdit)
    {
      break;
    }
  }
  if (e.State.Mesh.NumberOfVertices() > 0)
  {
    Renumber(e);
  }
}
}

void TakeGiven(Evolution& e, const IndexedSurface& given)
{
  const IndexedSurface surface = WithoutUnusedPoints(given);
  // Edits of an iteration suffice for a mesh near the constraints, without very long edges and full
  // rings. Long edges, slivers and fans are remeshed first.
  const SurfaceState& s = e.State;
  const float delta = s.Sizing.OfLevel();
  const EdgeLengths lengths = LengthsOf(surface);
  if (lengths.Longest <= SizingField::LongestEdgeInDelta * delta && FitsRings(surface) &&
    !IsTooDense(surface, delta))
  {
    Begin(e, surface);
    if (Proximity::FindIntersections(e.State, AliveVertices(e), e.Threads).empty())
    {
      if (lengths.Shortest < delta)
      {
        Adapt(e);
      }
      // Edits are verified for meshes without intersections only.
      if (e.Stopped || IsSound(s.Mesh.ToIndexed(), delta))
      {
        return;
      }
    }
  }
  TakeRemeshed(e, surface);
}

void TakeRemeshed(Evolution& e, const IndexedSurface& surface)
{
  const SurfaceState& s = e.State;
  const float delta = s.Sizing.OfLevel();
  const IndexedSurface fine = Remesh(e, surface);
  if (!e.Stopped)
  {
    // Parts thinner than the lattice leave fragments only.
    const double share = ComputeFeatures(fine).Volume / ComputeFeatures(surface).Volume;
    if (!(share > LeastShareOfVolume))
    {
      ThrowInvalidArgument(
        "The initial surface is too thin for this level, whose triangles have edges of about ",
        SizingField::RestLengthInDelta * delta, " voxel distances: they would hold ",
        std::lround(100. * std::max(share, 0.)),
        " % of its volume. Start at a finer level, give a thicker surface, or check that its "
        "coordinates are in the image's unit.");
    }
  }
  Begin(e, fine);
  Adapt(e);
  if (!e.Stopped && s.Mesh.NumberOfVertices() == 0)
  {
    ThrowInvalidArgument(
      "The initial surface is too small for this level, whose triangles have edges of about ",
      SizingField::RestLengthInDelta * delta,
      " voxel distances: none of it is left. Start at a finer level, give a larger surface, or "
      "check that its coordinates are in the image's unit.");
  }
  if (!e.Stopped && !IsSound(s.Mesh.ToIndexed(), delta))
  {
    ThrowInvalidArgument("The initial surface could not be brought to edges between ", delta,
      " and ", SizingField::LongestEdgeInDelta * delta,
      " voxel distances without an intersection. Remesh it to such edges before it is given, or "
      "choose another Initialization.");
  }
}
}

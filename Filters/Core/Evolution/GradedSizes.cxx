// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/GradedSizes.h"

#include "Core/Evolution/Evolution.h"
#include "Core/Image/DistanceToZero.h"
#include "Core/Mesh/LimitedSizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace volumic
{
namespace
{
/** Vertices per span of a parallel loop. */
constexpr std::size_t VertexGrain = 2048;
/**
 * Target, as a fraction of the tolerance, because the regularisation moves vertices along the
 * surface. With 1 a tenth fewer vertices keep it at 97 % of the points of
 * GradedSurface.HasFewerTriangles*.
 */
constexpr float AimedShare = 0.8f;
/** Smallest factor of a change: that of a level, so that an edge is split into two or three. */
constexpr float LeastChange = 0.57735f;
/**
 * Distance of a vertex to the isosurface of a finer level, in units of that level, above which the
 * surface is divided there: the level shows new features.
 */
constexpr float MostOffset = 0.5f;
/**
 * Radius around a missed voxel in which the smallest delta is required to recover its part, in
 * delta: twice the circumradius of a cell of the recovery lattice, and the longest reach.
 */
constexpr float NearMissedInDelta = 9.f;
/** Relative change of a size that is ignored. */
constexpr float SmallChange = 0.02f;
/**
 * Smallest thickness of a wall in delta of its vertices: sqrt 3 times their least distance by eq.
 * (1). Intersections are rejected in any case; in thinner walls too many edits would be.
 */
constexpr float WallInDelta = 2.5f;
/** Step of the search for walls, in the smallest delta. */
constexpr float WallStep = 0.5f;
/** Range of the search for the isosurface, in units of the level or tolerances. */
constexpr float FurthestInUnits = 2.f;
constexpr float FurthestInTolerances = 3.f;
}

GradedSizes::GradedSizes(
  SurfaceState& state, const Field& field, const Grading& grading, Executor& executor)
  : State(state), TheField(field), Requested(grading), Threads(executor),
    Near(grading.HasTolerance() ? static_cast<float>(grading.Tolerance)
                                : MostOffset * static_cast<float>(field.Image().Unit)),
    Least(state.Sizing.OfLevel()),
    Most(static_cast<float>(grading.Growth(
           SizingField::LongestEdgeInDelta * static_cast<double>(state.Sizing.OfLevel()))) *
      state.Sizing.OfLevel())
{
}

void GradedSizes::Begin(float delta)
{
  // Parts of an evolving surface approach each other independently of their sizes.
  constexpr float any = 1.f;
  const float most = this->Requested.HasTolerance() ? this->Most : delta;
  const float first = std::max(this->Least, std::min(delta, most));
  this->State.Size.Fill(first);
  this->State.Sizing = this->State.Sizing.Graded(this->State.Size.AsVector(), first, any);
}

void GradedSizes::Widen()
{
  this->State.Sizing = this->State.Sizing.Graded(
    this->State.Size.AsVector(), this->Most, static_cast<float>(this->Requested.Gradation));
}

float GradedSizes::Furthest() const
{
  return std::max(FurthestInUnits * static_cast<float>(this->TheField.Image().Unit),
    FurthestInTolerances * static_cast<float>(this->Requested.Tolerance));
}

float GradedSizes::SignedDistanceAt(const Vector& position, const Vector& normal) const
{
  const Field::Sample sample = this->TheField.At(position);
  const float near = sample.Value / this->TheField.SlopeOf(sample);
  if (std::abs(near) <= this->Near)
  {
    return -near;
  }
  // The estimate fails where the slope changes: search.
  return SignedDistanceToZero(position, normal, sample.Value, this->Furthest(),
    [this](const Vector& position) { return this->TheField.ValueAt(position); });
}

template <typename Visit>
void GradedSizes::VisitMiddles(std::size_t begin, std::size_t end, const Visit& visit) const
{
  const LargeVector<Vector>& position = this->State.Mesh.Position;
  this->State.Mesh.VisitFaces(begin, end,
    [&](int a, int b, int c)
    {
      visit((position[a] + position[b] + position[c]) * (1.f / 3.f), std::array<int, 3>{ a, b, c });
      for (const auto& [u, v] : { std::pair<int, int>{ a, b }, { b, c }, { c, a } })
      {
        if (u < v) // One of the two faces at an edge.
        {
          visit((position[u] + position[v]) * 0.5f, std::array<int, 2>{ u, v });
        }
      }
    });
}

template <typename OfMiddle>
GradedSizes::Largest GradedSizes::LargestAbout(const OfMiddle& of) const
{
  // Threads write to common vertices. The maximum does not depend on their order.
  Largest largest(this->State.Mesh.Rings.size());
  this->Threads.For(largest.size(), VertexGrain,
    [&](std::size_t begin, std::size_t end)
    {
      this->VisitMiddles(begin, end,
        [&](const Vector& middle, const auto& corners)
        {
          const float distance =
            of(this->SignedDistanceAt(middle, this->State.Normal[corners[0]].Axis()), corners);
          for (const int v : corners)
          {
            float before = largest[v].load(std::memory_order_relaxed);
            while (before < distance &&
              !largest[v].compare_exchange_weak(before, distance, std::memory_order_relaxed))
            {
            }
          }
        });
    });
  return largest;
}

float GradedSizes::DistanceToWall(int v, float side, float from, float most) const
{
  const Vector p = this->State.Mesh.Position[v];
  const Vector normal = this->State.Normal[v].Axis();
  const float step = WallStep * this->Least;
  float before = this->TheField.ValueAt(p + normal * (side * from));
  if ((before > 0) != (side < 0))
  {
    return from; // thinner than `from`, or the normal is meaningless
  }
  for (float distance = from + step; distance < most + step; distance += step)
  {
    const float value = this->TheField.ValueAt(p + normal * (side * distance));
    if ((value > 0) != (before > 0))
    {
      return std::min(distance - step * value / (value - before), most);
    }
    before = value;
  }
  return most;
}

float GradedSizes::MostBetweenWalls(int v, float size) const
{
  for (const float side : { -1.f, 1.f })
  {
    const float most = WallInDelta * size;
    const float distance = this->DistanceToWall(v, side, this->Least, most);
    size = distance < most ? std::max(distance / WallInDelta, this->Least) : size;
  }
  return size;
}

float GradedSizes::ThicknessAt(int v) const
{
  const float most = Grading::MostThickness * this->Least;
  const float from = WallStep * this->Least;
  return std::min(
    this->DistanceToWall(v, -1.f, from, most), this->DistanceToWall(v, 1.f, from, most));
}

float GradedSizes::RequestedSize(int v, float distance, float growth) const
{
  const float aimed = AimedShare * static_cast<float>(this->Requested.Tolerance);
  const float change = distance > 0.f ? std::sqrt(aimed / distance) : growth;
  const float size = std::clamp(
    this->State.Sizing.At(v) * std::clamp(change, LeastChange, growth), this->Least, this->Most);
  return size > this->Least ? this->MostBetweenWalls(v, size) : size;
}

float GradedSizes::RefinedSize(int v, float offset, float sag) const
{
  float size = this->State.Sizing.At(v);
  if (std::abs(offset) > MostOffset * static_cast<float>(this->TheField.Image().Unit))
  {
    return this->Least;
  }
  if (this->Requested.HasTolerance())
  {
    const float aimed = AimedShare * static_cast<float>(this->Requested.Tolerance);
    size *= sag > aimed ? std::sqrt(aimed / sag) : 1.f;
  }
  return size > this->Least ? this->MostBetweenWalls(v, size) : this->Least;
}

std::vector<int> GradedSizes::Refine()
{
  const SurfaceState& s = this->State;
  LargeVector<float> offsets(s.Mesh.Rings.size(), 0.f);
  ForAlive(s.Mesh, this->Threads,
    [&](int v) { offsets[v] = this->SignedDistanceAt(s.Mesh.Position[v], s.Normal[v].Axis()); });
  // Distance of the midpoints if their corners were on the isosurface.
  const auto sag = [&offsets](float distance, const auto& corners)
  {
    float moved = 0.f;
    for (const int v : corners)
    {
      moved += offsets[v];
    }
    return std::abs(distance - moved / static_cast<float>(corners.size()));
  };
  const Largest sags =
    this->Requested.HasTolerance() ? this->LargestAbout(sag) : Largest(offsets.size());
  return this->Change([&](int v) { return this->RefinedSize(v, offsets[v], sags[v]); });
}

std::vector<int> GradedSizes::ShrinkNear(const std::vector<Vector>& positions)
{
  const SurfaceState& s = this->State;
  LargeVector<std::uint8_t> isNear(s.Mesh.Rings.size(), 0);
  for (const Vector& position : positions)
  {
    s.Grid.Visit(position, NearMissedInDelta * this->Least, [&](int v) { isNear[v] = 1; });
  }
  return this->Change([&](int v) { return isNear[v] ? this->Least : s.Sizing.At(v); });
}

std::vector<int> GradedSizes::Adjust(float growth)
{
  const Largest distances =
    this->LargestAbout([](float distance, const auto&) { return std::abs(distance); });
  return this->Change([&](int v) { return this->RequestedSize(v, distances[v], growth); });
}

std::vector<int> GradedSizes::Change(const std::function<float(int v)>& requested)
{
  SurfaceState& s = this->State;
  LargeVector<float> sizes(s.Mesh.Rings.size(), this->Least);
  ForAlive(s.Mesh, this->Threads, [&](int v) { sizes[v] = requested(v); });
  sizes = LimitedSizes(sizes, s.Mesh.Position, s.Grid, this->Least,
    static_cast<float>(this->Requested.Gradation), this->Threads);
  std::vector<int> changed;
  for (int v = 0; v < s.Mesh.Size(); ++v)
  {
    if (s.Mesh.IsAlive(v))
    {
      const float before = s.Size[v];
      s.Size[v] = sizes[v];
      if (std::abs(sizes[v] - before) > SmallChange * before)
      {
        changed.push_back(v);
      }
    }
  }
  return changed;
}

Fit GradedSizes::Measure() const
{
  struct Sum
  {
    float Largest = 0.f;
    std::size_t Within = 0;
    std::size_t All = 0;
  };
  const SurfaceState& s = this->State;
  const float tolerance = static_cast<float>(this->Requested.Tolerance);
  const Sum all = JoinVertices(
    s.Mesh, this->Threads, Sum(),
    [&](int v, Sum& sum)
    {
      this->VisitMiddles(v, v + 1,
        [&](const Vector& middle, const auto& corners)
        {
          const float distance =
            std::abs(this->SignedDistanceAt(middle, s.Normal[corners[0]].Axis()));
          sum.Largest = std::max(sum.Largest, distance);
          sum.Within += distance <= tolerance;
          ++sum.All;
        });
    },
    [](const Sum& a, const Sum& b) {
      return Sum{ std::max(a.Largest, b.Largest), a.Within + b.Within, a.All + b.All };
    });
  Fit fit;
  fit.LargestDistance = all.Largest;
  fit.WithinTolerance =
    all.All > 0 ? static_cast<double>(all.Within) / static_cast<double>(all.All) : 1.;
  return fit;
}
}

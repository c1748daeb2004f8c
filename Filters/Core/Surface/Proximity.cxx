// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Proximity.h"

#include "Core/Common/Spans.h"
#include "Core/Surface/PairSearchRadius.h"
#include "Core/Surface/StarIntersections.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace volumic
{
namespace
{
// Lengths in delta.
/** Clearance of two stars above which their triangles are not tested. */
constexpr float LeastClearance = 2e-3f;
constexpr std::size_t TestedSpan = 64;
/** Clearance of a vertex without others in its search radius. */
constexpr float ReachClearance = 0.1f;
/** Search radius of pairs, which are kept until their vertices have used up their clearance. */
constexpr float PairRadius = SizingField::LambdaInDelta + ReachClearance;

/** Tests vertices, with the buffers of one thread. */
class Search
{
public:
  Search(SurfaceState& state) : State(state) {}

  /** Call visit(w, squared distance) for vertices within a radius and with an opposed cone. */
  template <typename Visitor>
  void VisitOpposed(int v, float radius, const Visitor& visit);
  /** Set NearOthers and ClearanceAtTest of a vertex, except for Findings::Touching. */
  void Test(int v, Proximity::Findings& found);

private:
  /** Fill Near with the vertices within a radius of a position. Return their number. */
  std::size_t FindNear(const Vector& position, float radius);

  /** Capacity for one more group of visited vertices, rounded up to whole lanes. */
  static constexpr std::size_t GroupCapacity = VertexGrid::LargestGroup + Lanes::Count;

  SurfaceState& State;
  std::vector<int> Near = std::vector<int>(GroupCapacity);
  std::vector<float> Squared = std::vector<float>(GroupCapacity); ///< Squared distances.
  /** Star of the tested vertex, built on first use: most vertices do not need it. */
  std::vector<StarFaces> Own;
};

std::size_t Search::FindNear(const Vector& position, float radius)
{
  std::size_t visited = 0;
  const Vector margin(radius, radius, radius);
  this->State.Grid.VisitGroups(position - margin, position + margin,
    [&](const int* group, int count)
    {
      if (this->Near.size() < visited + GroupCapacity)
      {
        this->Near.resize(2 * visited + GroupCapacity);
        this->Squared.resize(this->Near.size());
      }
      for (int i = 0; i < count; i += Lanes::Count)
      {
        std::copy(group + i, group + i + Lanes::Count, this->Near.data() + visited + i);
      }
      visited += static_cast<std::size_t>(count);
    });
  int* const near = this->Near.data();
  float* const squared = this->Squared.data();
  std::fill_n(near + visited, Lanes::Count, near[0]);
  const Vector* const positions = this->State.Mesh.Position.data();
  const VectorLanes from = AllLanes(position);
  const Lanes largest(radius * radius);
  std::size_t count = 0;
  for (std::size_t i = 0; i < visited; i += Lanes::Count)
  {
    const int four[Lanes::Count] = { near[i], near[i + 1], near[i + 2], near[i + 3] };
    float distance[Lanes::Count];
    const Lanes lanes = SquaredLength(
      Gather(positions[four[0]], positions[four[1]], positions[four[2]], positions[four[3]]) -
      from);
    lanes.Store(distance);
    const unsigned beyond =
      LessBits(largest, lanes) | ~0u << std::min<std::size_t>(visited - i, Lanes::Count);
    for (int k = 0; k < Lanes::Count; ++k) // Branchless: vertices beyond are overwritten.
    {
      near[count] = four[k];
      squared[count] = distance[k];
      count += ~beyond >> k & 1u;
    }
  }
  return count;
}

template <typename Visitor>
void Search::VisitOpposed(int v, float radius, const Visitor& visit)
{
  const std::size_t count = this->FindNear(this->State.Mesh.Position[v], radius);
  const int* const near = this->Near.data();
  const NormalCone* const cones = this->State.Normal.AsVector().data();
  const NormalCone cone = cones[v];
  for (std::size_t i = 0; i < count; i += Lanes::Count)
  {
    const int* w = near + i; // Valid indices follow after the last one.
    unsigned opposed = OpposedBits(cone, cones[w[0]], cones[w[1]], cones[w[2]], cones[w[3]]);
    opposed &= ~(~0u << std::min<std::size_t>(count - i, Lanes::Count));
    for (; opposed != 0; opposed &= opposed - 1)
    {
      const int k = LowestBit(opposed);
      if (w[k] != v)
      {
        visit(w[k], this->Squared[i + k]);
      }
    }
  }
}

void Search::Test(int v, Proximity::Findings& found)
{
  SurfaceState& state = this->State;
  const SurfaceMesh& mesh = state.Mesh;
  const float delta = state.Sizing.At(v);
  const float largest = state.Sizing.SearchRadius(v);
  const PairSearchRadius pairRadius(state, v);
  const float extended =
    largest + (state.IsSlow[v] ? Proximity::ExtraSearchRadiusInDelta * delta : 0.f);
  const float near = PairRadius * delta;
  const float least = ReachClearance * delta;
  this->Own.clear();
  const auto star = [&]() -> const StarFaces&
  {
    if (this->Own.empty())
    {
      this->Own.emplace_back(mesh, v);
    }
    return this->Own.front();
  };
  bool anything = false;
  float clearanceOfStar = extended - largest + least;
  if (state.AreOpposed(v, v))
  {
    anything = true;
    clearanceOfStar = std::min(clearanceOfStar, TestStars(state, star(), star(), found));
  }
  this->VisitOpposed(v, extended,
    [&](int w, float squared)
    {
      const float radius = pairRadius.With(w, squared);
      if (squared > radius * radius)
      {
        clearanceOfStar = std::min(clearanceOfStar, std::sqrt(squared) - radius + least);
        return;
      }
      clearanceOfStar = std::min(
        clearanceOfStar, std::max(least, std::sqrt(squared) - state.Sizing.Clearance(v, w)));
      anything = true;
      if (squared < near * near && !mesh.AreNeighbours(v, w))
      {
        found.Pairs.push_back({ v, w, squared });
      }
      const StarFaces& first = star();
      const bool isShared = first.Shares(w, mesh.Rings[w]);
      const bool tests = v < w || !(state.Marks[w] & IsListed) ||
        squared >
          state.Sizing.SearchRadius(w) * state.Sizing.SearchRadius(w); // Its own radius is smaller.
      if (isShared && !tests)
      {
        clearanceOfStar = std::min(clearanceOfStar, TestedClearance * delta);
        return;
      }
      const StarFaces second(mesh, w);
      const float clearance = isShared ? 0.f : ClearanceBetween(state, first, second);
      clearanceOfStar = std::min(clearanceOfStar,
        clearance >= LeastClearance * delta ? clearance
          : tests                           ? TestStars(state, first, second, found)
                                            : TestedClearance * delta);
    });
  state.NearOthers[v] = anything;
  state.ClearanceAtTest[v] = clearanceOfStar;
}
}

void Proximity::AddPairs(SurfaceState& state, const std::vector<int>& vertices)
{
  Search search(state);
  for (const int v : vertices)
  {
    search.VisitOpposed(v, PairRadius * state.Sizing.At(v),
      [&](int w, float squared)
      {
        if (!state.Mesh.AreNeighbours(v, w))
        {
          this->AllPairs.push_back({ v, w, squared });
        }
      });
  }
}

void Proximity::Test(SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  for (const int v : vertices)
  {
    state.Marks[v] |= IsListed;
  }
  // Keep the pairs of vertices that are not tested.
  this->AllPairs.erase(std::remove_if(this->AllPairs.begin(), this->AllPairs.end(),
                         [&state](const ClosePair& pair)
                         {
                           return (state.Marks[pair.V] & IsListed) || !state.Mesh.IsAlive(pair.V) ||
                             !state.Mesh.IsAlive(pair.W);
                         }),
    this->AllPairs.end());
  const std::size_t spans = (vertices.size() + TestedSpan - 1) / TestedSpan;
  this->OfSpans.resize(std::max(this->OfSpans.size(), spans));
  executor.For(spans, 1,
    [&](std::size_t begin, std::size_t end)
    {
      Search search(state);
      for (std::size_t span = begin; span < end; ++span)
      {
        Proximity::Findings& found = this->OfSpans[span];
        found.Pairs.clear();
        found.Intersections.clear();
        found.Touching.clear();
        const std::size_t last = std::min(vertices.size(), (span + 1) * TestedSpan);
        for (std::size_t i = span * TestedSpan; i < last; ++i)
        {
          if (state.Mesh.IsAlive(vertices[i]))
          {
            search.Test(vertices[i], found);
          }
        }
      }
    });
  this->AllIntersections.clear();
  for (std::size_t span = 0; span < spans; ++span)
  {
    const Proximity::Findings& found = this->OfSpans[span];
    this->AllPairs.insert(this->AllPairs.end(), found.Pairs.begin(), found.Pairs.end());
    this->AllIntersections.insert(
      this->AllIntersections.end(), found.Intersections.begin(), found.Intersections.end());
    // Each pair of faces is tested once. Clear the clearance of all its corners.
    for (const int v : found.Touching)
    {
      state.ClearanceAtTest[v] = 0;
    }
  }
  for (const int v : vertices)
  {
    state.Marks[v] &= static_cast<std::uint8_t>(~IsListed);
  }
}

std::vector<Proximity::FacePair> Proximity::FindIntersections(
  SurfaceState& state, const std::vector<int>& vertices, Executor& executor)
{
  Proximity all;
  all.Test(state, vertices, executor);
  return std::move(all.AllIntersections);
}
}

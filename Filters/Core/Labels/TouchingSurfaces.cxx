// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/TouchingSurfaces.h"

#include "Core/Common/Spans.h"
#include "Core/Mesh/SelfIntersections.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Mesh/TriangleTree.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

namespace volumic
{
namespace
{
/** What is nearer touches, in voxels: it could meet when written with other coordinates. */
constexpr double Tolerance = 1e-4;

bool Overlap(const Bounds& a, const Bounds& b)
{
  bool overlap = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    overlap = overlap && a.Low[axis] <= b.High[axis] + Tolerance &&
      b.Low[axis] <= a.High[axis] + Tolerance;
  }
  return overlap;
}

/** The triangles of the components within another surface, none of whose are among `touching`. */
std::vector<int> FindEnclosed(const IndexedSurface& surface, const SurfaceFeatures& features,
  const std::vector<int>& touching, const TriangleTree& other)
{
  enum class State : char
  {
    Unknown,
    Outside,
    Inside
  };
  std::vector<State> states(features.Components.size(), State::Unknown);
  for (const int t : touching)
  {
    states[features.ComponentOfTriangle[t]] = State::Outside;
  }
  std::vector<int> enclosed;
  for (int t = 0; t < static_cast<int>(surface.Triangles.size()); ++t)
  {
    State& state = states[features.ComponentOfTriangle[t]];
    if (state == State::Unknown)
    {
      const Point& place = surface.Points[static_cast<std::size_t>(surface.Triangles[t][0])];
      const bool isInside = other.WindingAbout(place, [](int) { return true; }) != 0;
      state = isInside ? State::Inside : State::Outside;
    }
    if (state == State::Inside)
    {
      enclosed.push_back(t);
    }
  }
  return enclosed;
}

void Unite(std::vector<SurfaceTriangle>& triangles)
{
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}
}

std::vector<std::vector<SurfaceTriangle>> FindTouching(
  const std::vector<IndexedSurface>& surfaces, Executor& executor)
{
  const std::size_t count = surfaces.size();
  std::vector<Bounds> bounds(count);
  std::vector<std::unique_ptr<TriangleTree>> trees(count);
  ForSpans(executor, count, 1,
    [&](std::size_t i, std::size_t, std::size_t)
    {
      bounds[i] = Bounds::Of(surfaces[i]);
      trees[i] = std::make_unique<TriangleTree>(surfaces[i]);
    });
  std::vector<std::vector<SurfaceTriangle>> meeting(count);
  std::vector<std::vector<std::pair<std::size_t, SurfaceTriangle>>> within(count);
  ForSpans(executor, count, 1,
    [&](std::size_t i, std::size_t, std::size_t)
    {
      const SurfaceFeatures features = ComputeFeatures(surfaces[i]);
      for (std::size_t other = 0; other < count; ++other)
      {
        if (other == i || !Overlap(bounds[i], bounds[other]))
        {
          continue;
        }
        const std::vector<int> touching =
          FindIntersecting(surfaces[i], surfaces[other], *trees[other], Tolerance);
        for (const int t : touching)
        {
          meeting[i].push_back({ i, t });
        }
        for (const int t :
          FindEnclosed(surfaces[i], features, touching, *trees[other]))
        {
          within[i].push_back({ other, { i, t } });
        }
      }
    });
  for (const auto& ofOne : within)
  {
    for (const auto& [other, triangle] : ofOne)
    {
      meeting[other].push_back(triangle);
    }
  }
  std::for_each(meeting.begin(), meeting.end(), Unite);
  return meeting;
}
}

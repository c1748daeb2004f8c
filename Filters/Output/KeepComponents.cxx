// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Output/KeepComponents.h"

#include "Core/Common/Spans.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Mesh/RowCrossing.h"
#include "Core/Mesh/SurfaceFeatures.h"
#include "Core/Surface/SizingField.h"
#include "Input/ComputationalSpace.h"
#include "Input/InputPoints.h"
#include "Settings/SegmentationSettings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** Triangles that one thread looks at at a time. */
constexpr std::size_t SpanSize = 16384;

/**
 * For each place the innermost component that encloses it, -1 if none; `own` (may be empty) does
 * not count.
 */
std::vector<int> InnermostAbout(const std::vector<Point>& places, const std::vector<int>& own,
  const LargeVector<Point>& points, const LargeVector<Triangle>& triangles,
  const SurfaceFeatures& features, Executor& executor)
{
  const std::vector<std::vector<int>> about = EnclosingComponents(
    places, own, triangles.size(),
    [&](std::size_t begin, std::size_t end, const auto& visit)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        const Triangle& triangle = triangles[t];
        visit(points[triangle[0]], points[triangle[1]], points[triangle[2]],
          features.ComponentOfTriangle[t]);
      }
    },
    executor);
  std::vector<int> innermost(places.size(), -1);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    double least = 0.0;
    for (const int component : about[i])
    {
      const double volume = std::abs(features.Components[component].Volume);
      if (innermost[i] < 0 || volume < least)
      {
        innermost[i] = component;
        least = volume;
      }
    }
  }
  return innermost;
}

/** Remove the points and triangles of all other components. */
void LeaveShape(
  SurfaceResult& surface, const SurfaceFeatures& features, const std::vector<bool>& isKept)
{
  LargeVector<int> index(surface.Points.size(), -1);
  std::size_t count = 0;
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (isKept[features.ComponentOfTriangle[t]])
    {
      surface.Triangles[count++] = surface.Triangles[t];
      for (const int corner : surface.Triangles[t])
      {
        index[corner] = 0;
      }
    }
  }
  surface.Triangles.resize(count);
  int points = 0;
  for (int& i : index)
  {
    i = i == 0 ? points++ : -1;
  }
  surface.VisitPoints(
    [&](auto& values)
    {
      for (std::size_t p = 0; p < values.size(); ++p)
      {
        if (index[p] >= 0)
        {
          values[index[p]] = values[p];
        }
      }
      values.resize(values.empty() ? 0 : points);
    });
  const auto isGone = [&](const std::array<int, 2>& pair)
  { return index[pair[0]] < 0 || index[pair[1]] < 0; };
  surface.Contacts.erase(std::remove_if(surface.Contacts.begin(), surface.Contacts.end(), isGone),
    surface.Contacts.end());
  for (std::array<int, 2>& pair : surface.Contacts)
  {
    pair = { index[pair[0]], index[pair[1]] };
  }
  for (Triangle& triangle : surface.Triangles)
  {
    triangle = { index[triangle[0]], index[triangle[1]], index[triangle[2]] };
  }
}

/** Remove the features of all other components. */
void LeaveFeatures(
  SurfaceFeatures& features, std::vector<int>& owners, const std::vector<bool>& isKept)
{
  SurfaceFeatures kept;
  std::vector<int> number(isKept.size(), -1);
  for (std::size_t c = 0; c < isKept.size(); ++c)
  {
    if (isKept[c])
    {
      number[c] = static_cast<int>(kept.Components.size());
      const ComponentFeatures& component = features.Components[c];
      kept.Components.push_back(component);
      kept.Area += component.Area;
      kept.Volume += component.Volume;
      kept.EulerCharacteristic += 2 - 2 * component.Genus;
      kept.Genus += component.Genus;
    }
  }
  std::vector<int> keptOwners;
  for (std::size_t c = 0; c < isKept.size(); ++c)
  {
    if (isKept[c])
    {
      keptOwners.push_back(number[owners[c]]);
    }
  }
  for (const int component : features.ComponentOfTriangle)
  {
    if (isKept[component])
    {
      kept.ComponentOfTriangle.push_back(number[component]);
    }
  }
  features = std::move(kept);
  owners = std::move(keptOwners);
}

/**
 * Mark the components that enclose a position.
 * @param points in computational space, as the positions
 * @return the positions that none encloses
 */
std::vector<Point> MarkEnclosing(const LargeVector<Point>& points, const DescribedSurface& surface,
  const std::vector<Point>& places, std::vector<bool>& isKept, Executor& executor)
{
  const std::vector<int> innermost =
    InnermostAbout(places, {}, points, surface.Shape.Triangles, surface.Features, executor);
  std::vector<Point> others;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (innermost[i] >= 0 && surface.Features.Components[innermost[i]].Volume > 0)
    {
      isKept[innermost[i]] = true;
    }
    else
    {
      others.push_back(places[i]);
    }
  }
  return others;
}

/** Mark the owners of the components that pass near a position. @see MarkEnclosing() */
void MarkNear(const LargeVector<Point>& points, const DescribedSurface& surface,
  const std::vector<Point>& places, std::vector<bool>& isKept, Executor& executor)
{
  const LargeVector<Triangle>& triangles = surface.Shape.Triangles;
  const SortedPoints sorted(places);
  const double reach = SizingField::LongestEdgeInDelta * surface.Shape.Delta;
  std::vector<std::vector<int>> touching((triangles.size() + SpanSize - 1) / SpanSize);
  ForSpans(executor, triangles.size(), SpanSize,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        const int owner = surface.Owners[surface.Features.ComponentOfTriangle[t]];
        for (const int corner : triangles[t])
        {
          const Point& p = points[corner];
          sorted.Visit(p[1] - reach, p[1] + reach,
            [&](int i)
            {
              const double x = p[0] - places[i][0];
              const double y = p[1] - places[i][1];
              const double z = p[2] - places[i][2];
              if (owner >= 0 && x * x + y * y + z * z <= reach * reach)
              {
                touching[span].push_back(owner);
              }
            });
        }
      }
    });
  for (const int owner : Joined(executor, touching))
  {
    isKept[owner] = true;
  }
}

/** Return DescribedSurface::Owners. The cost is negligible without cavities. */
std::vector<int> OwnersOf(
  const IndexedSurface& surface, const SurfaceFeatures& features, Executor& executor)
{
  const int n = static_cast<int>(features.Components.size());
  std::vector<int> owners(static_cast<std::size_t>(n));
  std::iota(owners.begin(), owners.end(), 0);
  if (std::none_of(features.Components.begin(), features.Components.end(),
        [](const ComponentFeatures& component) { return component.Volume < 0; }))
  {
    return owners;
  }
  std::vector<int> cavities;
  std::vector<Point> places; // Of each a corner of its first triangle here.
  std::vector<bool> isDone(static_cast<std::size_t>(n), false);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const int component = features.ComponentOfTriangle[t];
    if (!isDone[component] && features.Components[component].Volume < 0)
    {
      cavities.push_back(component);
      places.push_back(surface.Points[surface.Triangles[t][0]]);
    }
    isDone[component] = true;
  }
  const std::vector<int> about =
    InnermostAbout(places, cavities, surface.Points, surface.Triangles, features, executor);
  for (std::size_t i = 0; i < cavities.size(); ++i)
  {
    const bool isSolid = about[i] >= 0 && features.Components[about[i]].Volume > 0;
    owners[cavities[i]] = isSolid ? about[i] : -1;
  }
  return owners;
}
}

ComponentChoice ChoiceOf(const SegmentationRequest& request, const ComputationalSpace& space,
  const std::array<int, 3>& size)
{
  const SegmentationEnd& end = request.Settings.End;
  CheckEnumeration("Keep Components", end.KeepComponents, KeepComponentsType::ComponentsNotAtSeeds);
  if (!(end.MinimumComponentVolume >= 0.0))
  {
    ThrowInvalidArgument(
      "Minimum Component Volume is ", end.MinimumComponentVolume, "; it must be 0 or more.");
  }
  ComponentChoice choice;
  choice.Mode = end.KeepComponents;
  choice.MinimumVolume = end.MinimumComponentVolume;
  const bool isAtPoints = choice.Mode == KeepComponentsType::ComponentsAtPoints;
  if (isAtPoints || choice.Mode == KeepComponentsType::ComponentsNotAtSeeds)
  {
    // Points known to belong to the object mark nothing that is to go.
    choice.Places = SelectionPositions(
      request.InitialSurface, isAtPoints ? request.AttractingPoints : nullptr, space);
    const auto add = [&](const std::vector<Point>& more)
    { choice.Places.insert(choice.Places.end(), more.begin(), more.end()); };
    add(PositionsOf(end.SeedPositions, "Seed Positions", space, size));
    if (isAtPoints)
    {
      add(PositionsOf(request.Settings.AttractingPositions, "Attracting Positions", space, size));
    }
    choice.Mode = choice.Places.empty() ? KeepComponentsType::AllComponents : choice.Mode;
  }
  return choice;
}

DescribedSurface DescribeSurface(SurfaceResult surface, const ComputationalSpace& space,
  const ComponentChoice& choice, Executor& executor)
{
  using Mode = KeepComponentsType;
  const bool dropsMarked = choice.Mode == Mode::ComponentsNotAtSeeds;
  const bool marks = dropsMarked || choice.Mode == Mode::ComponentsAtPoints;
  const bool hasSeeds = !choice.Seeds.empty();
  const LargeVector<Point> points = marks || hasSeeds ? surface.Points : LargeVector<Point>();
  DescribedSurface described;
  described.Shape = std::move(surface);
  IndexedSurface& shape = described.Shape;
  shape = ToWorld(std::move(shape), space, executor);
  described.Features = ComputeFeatures(shape, executor);
  described.Owners = OwnersOf(shape, described.Features, executor);
  if (choice.Mode == Mode::AllComponents && !hasSeeds)
  {
    return described;
  }
  const std::size_t n = described.Features.Components.size();
  std::vector<bool> isAtSeed(n, !hasSeeds);
  if (hasSeeds)
  {
    MarkNear(points, described, MarkEnclosing(points, described, choice.Seeds, isAtSeed, executor),
      isAtSeed, executor);
  }
  std::vector<bool> isKept(n, false);
  bool hasLargest = false;
  for (std::size_t c = 0; c < n; ++c)
  {
    const double volume = described.Features.Components[c].Volume;
    const bool isSolid = volume > 0 && isAtSeed[c];
    isKept[c] = isSolid &&
      (choice.Mode == Mode::LargeComponents ? volume >= choice.MinimumVolume
                                            : choice.Mode == Mode::AllComponents ||
            (choice.Mode == Mode::LargestComponent && !hasLargest));
    hasLargest = hasLargest || isSolid;
  }
  if (marks)
  {
    MarkEnclosing(points, described, choice.Places, isKept, executor);
    MarkNear(points, described, choice.Places, isKept, executor);
  }
  if (dropsMarked != choice.IsInverted)
  {
    isKept.flip();
  }
  for (std::size_t c = 0; c < n; ++c)
  {
    const int owner = described.Owners[c];
    isKept[c] = owner >= 0 && isKept[owner] && isAtSeed[owner];
  }
  LeaveShape(described.Shape, described.Features, isKept);
  LeaveFeatures(described.Features, described.Owners, isKept);
  return described;
}
}

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
constexpr std::size_t SpanSize = 16384;

/**
 * Return the innermost component that encloses each position, or -1.
 * @param own component of each position to ignore, may be empty
 */
std::vector<int> FindEnclosing(const std::vector<Point>& positions, const std::vector<int>& own,
  const LargeVector<Point>& points, const LargeVector<Triangle>& triangles,
  const SurfaceFeatures& features, Executor& executor)
{
  const std::vector<std::vector<int>> enclosing = EnclosingComponents(
    positions, own, triangles.size(),
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
  std::vector<int> innermost(positions.size(), -1);
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    double least = 0.0;
    for (const int component : enclosing[i])
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
void SelectShape(
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
  const auto isRemoved = [&](const std::array<int, 2>& pair)
  { return index[pair[0]] < 0 || index[pair[1]] < 0; };
  surface.Contacts.erase(
    std::remove_if(surface.Contacts.begin(), surface.Contacts.end(), isRemoved),
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
void SelectFeatures(
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
 * @param points points of the surface in computational space
 * @return the positions that no component encloses
 */
std::vector<Point> MarkEnclosing(const LargeVector<Point>& points, const DescribedSurface& surface,
  const std::vector<Point>& positions, std::vector<bool>& isKept, Executor& executor)
{
  const std::vector<int> innermost =
    FindEnclosing(positions, {}, points, surface.Shape.Triangles, surface.Features, executor);
  std::vector<Point> others;
  for (std::size_t i = 0; i < positions.size(); ++i)
  {
    if (innermost[i] >= 0 && surface.Features.Components[innermost[i]].Volume > 0)
    {
      isKept[innermost[i]] = true;
    }
    else
    {
      others.push_back(positions[i]);
    }
  }
  return others;
}

/** Mark the owners of components within 2.5 delta of a position. @see MarkEnclosing() */
void MarkNear(const LargeVector<Point>& points, const DescribedSurface& surface,
  const std::vector<Point>& positions, std::vector<bool>& isKept, Executor& executor)
{
  const LargeVector<Triangle>& triangles = surface.Shape.Triangles;
  const SortedPoints sorted(positions);
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
              const double x = p[0] - positions[i][0];
              const double y = p[1] - positions[i][1];
              const double z = p[2] - positions[i][2];
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
  std::vector<Point> corners; // a corner of each cavity
  std::vector<bool> isDone(static_cast<std::size_t>(n), false);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const int component = features.ComponentOfTriangle[t];
    if (!isDone[component] && features.Components[component].Volume < 0)
    {
      cavities.push_back(component);
      corners.push_back(surface.Points[surface.Triangles[t][0]]);
    }
    isDone[component] = true;
  }
  const std::vector<int> enclosing =
    FindEnclosing(corners, cavities, surface.Points, surface.Triangles, features, executor);
  for (std::size_t i = 0; i < cavities.size(); ++i)
  {
    const bool isSolid = enclosing[i] >= 0 && features.Components[enclosing[i]].Volume > 0;
    owners[cavities[i]] = isSolid ? enclosing[i] : -1;
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
      "Minimum Component Volume is ", end.MinimumComponentVolume, ". Set it to 0 or more.");
  }
  ComponentChoice choice;
  choice.Mode = end.KeepComponents;
  choice.MinimumVolume = end.MinimumComponentVolume;
  const bool isAtPoints = choice.Mode == KeepComponentsType::ComponentsAtPoints;
  if (isAtPoints || choice.Mode == KeepComponentsType::ComponentsNotAtSeeds)
  {
    // Attracting points do not mark components to remove.
    choice.Positions = SelectionPositions(
      request.InitialSurface, isAtPoints ? request.AttractingPoints : nullptr, space);
    const auto add = [&](const std::vector<Point>& more)
    { choice.Positions.insert(choice.Positions.end(), more.begin(), more.end()); };
    add(PositionsOf(end.SeedPositions, "Seed Positions", space, size));
    if (isAtPoints)
    {
      add(PositionsOf(request.Settings.AttractingPositions, "Attracting Positions", space, size));
    }
    choice.Mode = choice.Positions.empty() ? KeepComponentsType::AllComponents : choice.Mode;
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
    MarkEnclosing(points, described, choice.Positions, isKept, executor);
    MarkNear(points, described, choice.Positions, isKept, executor);
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
  SelectShape(described.Shape, described.Features, isKept);
  SelectFeatures(described.Features, described.Owners, isKept);
  return described;
}
}

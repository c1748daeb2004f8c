// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/DrawBack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
/** Triangles are looked at in so many steps along each side. */
constexpr int Steps = 4;
/** What the field must be there at least. */
constexpr double LeastInside = 0.02;

/** The voxels about a place, and the field there. */
struct Neighbourhood
{
  std::array<std::int64_t, 8> Voxels;
  double Value = 0.;

  Neighbourhood(const LabelField& field, const Point& place)
  {
    std::array<int, 3> first;
    std::array<double, 3> share;
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = std::clamp(static_cast<int>(std::floor(place[axis])), field.Box.First[axis],
        field.Box.End[axis] - 2);
      share[axis] = std::clamp(place[axis] - first[axis], 0., 1.);
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      double weight = 1.;
      std::array<int, 3> at = first;
      for (int axis = 0; axis < 3; ++axis)
      {
        const int upper = corner >> axis & 1;
        at[axis] += upper;
        weight *= upper != 0 ? share[axis] : 1. - share[axis];
      }
      this->Voxels[static_cast<std::size_t>(corner)] =
        field.Box.NumberOf(at[0], at[1], at[2]);
      this->Value += weight *
        static_cast<double>(field.Values[static_cast<std::size_t>(
          this->Voxels[static_cast<std::size_t>(corner)])]);
    }
  }
};

/** Calls visit(place) for places all over a triangle. */
template <typename Visit>
void ForPlacesOn(const IndexedSurface& surface, const Triangle& t, Visit&& visit)
{
  for (int i = 0; i <= Steps; ++i)
  {
    for (int j = 0; j <= Steps - i; ++j)
    {
      const std::array<double, 3> weights = { i / static_cast<double>(Steps),
        j / static_cast<double>(Steps), (Steps - i - j) / static_cast<double>(Steps) };
      Point place = { 0., 0., 0. };
      for (int corner = 0; corner < 3; ++corner)
      {
        const Point& p = surface.Points[static_cast<std::size_t>(t[corner])];
        for (int axis = 0; axis < 3; ++axis)
        {
          place[axis] += weights[corner] * p[axis];
        }
      }
      visit(place);
    }
  }
}
}

std::size_t DrawBackWithin(
  const LabelField& original, const IndexedSurface& surface, float by, LabelField& field)
{
  LargeVector<unsigned char> isLowered(field.Values.size(), 0);
  std::size_t outside = 0;
  for (const Triangle& t : surface.Triangles)
  {
    bool isOutside = false;
    ForPlacesOn(surface, t,
      [&](const Point& place)
      {
        const Neighbourhood about(original, place);
        if (about.Value < LeastInside)
        {
          isOutside = true;
          for (const std::int64_t voxel : about.Voxels)
          {
            isLowered[static_cast<std::size_t>(voxel)] = 1;
          }
        }
      });
    outside += isOutside ? 1 : 0;
  }
  for (std::size_t voxel = 0; voxel < isLowered.size(); ++voxel)
  {
    if (isLowered[voxel] != 0)
    {
      field.Values[voxel] -= by;
    }
  }
  return outside;
}

std::vector<std::array<int, 3>> VoxelsAbout(
  const std::vector<IndexedSurface>& surfaces, const std::vector<SurfaceTriangle>& triangles)
{
  std::vector<std::array<int, 3>> voxels;
  for (const SurfaceTriangle& t : triangles)
  {
    const IndexedSurface& surface = surfaces[t.Surface];
    ForPlacesOn(surface, surface.Triangles[static_cast<std::size_t>(t.Triangle)],
      [&](const Point& place)
      {
        for (int corner = 0; corner < 8; ++corner)
        {
          std::array<int, 3> at;
          for (int axis = 0; axis < 3; ++axis)
          {
            at[axis] = static_cast<int>(std::floor(place[axis])) + (corner >> axis & 1);
          }
          voxels.push_back(at);
        }
      });
  }
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}
}

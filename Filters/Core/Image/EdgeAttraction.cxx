// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/EdgeAttraction.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace volumic
{
namespace
{
/** Slope with the maximum force, in typical slopes. */
constexpr double SlopeAtBound = 0.5;

LevelImage MapOf(const LevelImage& image)
{
  LevelImage map = image;
  map.Values = image.Edges;
  map.Edges = VoxelValues();
  map.Base = 0.; // Only differences matter.
  return map;
}

FieldOptions MapOptions()
{
  FieldOptions options;
  options.BorderValue = Border::Replicate;
  return options;
}
}

EdgeAttraction::EdgeAttraction(const LevelImage& image, Executor& executor)
  : Map(MapOf(image), MapOptions(), executor)
{
  // Central differences of the inner voxels, one sum per slice.
  const auto& size = image.Size;
  struct Sums
  {
    double First = 0;
    double Second = 0;
  };
  std::vector<Sums> slices(static_cast<std::size_t>(size[2]));
  const std::ptrdiff_t dy = size[0];
  const std::ptrdiff_t dz = dy * size[1];
  image.Edges.Visit(
    [&](const auto& edges)
    {
      executor.For(slices.size(), 1,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t k = std::max<std::size_t>(begin, 1);
               k < std::min(end, slices.size() - 1); ++k)
          {
            Sums sums;
            for (int j = 1; j + 1 < size[1]; ++j)
            {
              const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(k) * dz + j * dy;
              for (std::ptrdiff_t i = row + 1; i + 1 < row + size[0]; ++i)
              {
                const double x = (edges[i + 1] - edges[i - 1]) / image.Step[0];
                const double y = (edges[i + dy] - edges[i - dy]) / image.Step[1];
                const double z = (edges[i + dz] - edges[i - dz]) / image.Step[2];
                const double squared = 0.25 * (x * x + y * y + z * z); // differences over two steps
                sums.First += std::sqrt(squared);
                sums.Second += squared;
              }
            }
            slices[k] = sums;
          }
        });
    });
  Sums all;
  for (const Sums& sums : slices)
  {
    all.First += sums.First;
    all.Second += sums.Second;
  }
  if (all.Second > 0)
  {
    this->Scale = static_cast<float>(all.First / (SlopeAtBound * all.Second));
  }
}

float EdgeAttraction::Along(const Vector& position, const Vector& normal) const
{
  const float slope = Dot(this->Map.At(position).Gradient, normal);
  return std::min(std::max(slope * this->Scale, -1.f), 1.f);
}
}

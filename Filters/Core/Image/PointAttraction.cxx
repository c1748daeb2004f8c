// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/PointAttraction.h"

#include "Core/Image/Field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace volumic
{
namespace
{
/** Support of phi, in radii. */
constexpr double Reach = 1.5;
/** k: log(2) / phi(1), phi(1) = (5/9)^2. */
constexpr float Sharpness = 2.2458f;
/** C, relative to the typical slope times the unit of the level. */
constexpr float ContrastFraction = 0.25f;

/** Return the first and last voxel within a distance along an axis, clamped to the image. */
std::pair<int, int> Range(const LevelImage& image, int axis, double centre, double distance)
{
  const double step = image.Step[axis];
  const double last = image.Size[axis] - 1;
  return { static_cast<int>(std::max(0., std::ceil((centre - distance) / step))),
    static_cast<int>(std::min(last, std::floor((centre + distance) / step))) };
}
}

PointAttraction::PointAttraction(std::vector<AttractingPoint> points, double weight)
  : Points(std::move(points)), Weight(weight)
{
}

double PointAttraction::ReachOf(const LevelImage& image, const AttractingPoint& point)
{
  return Reach * std::max(point.Radius, LeastRadius * image.Unit);
}

void PointAttraction::AddPoint(const LevelImage& image, const AttractingPoint& point, int slice,
  std::vector<float>& evidence) const
{
  const double reach = ReachOf(image, point);
  const double dz = slice * image.Step[2] - point.Position[2];
  const auto rows = Range(image, 1, point.Position[1], reach);
  const auto columns = Range(image, 0, point.Position[0], reach);
  for (int j = rows.first; j <= rows.second; ++j)
  {
    const double dy = j * image.Step[1] - point.Position[1];
    float* row = evidence.data() + static_cast<std::size_t>(j) * image.Size[0];
    for (int i = columns.first; i <= columns.second; ++i)
    {
      const double dx = i * image.Step[0] - point.Position[0];
      const double falloff = 1. - (dx * dx + dy * dy + dz * dz) / (reach * reach);
      if (falloff > 0.)
      {
        row[i] += static_cast<float>(this->Weight * point.Weight * falloff * falloff);
      }
    }
  }
}

std::vector<float> PointAttraction::Bend(
  const LevelImage& image, const FieldOptions& options, Executor& executor) const
{
  const std::size_t slice = static_cast<std::size_t>(image.Size[0]) * image.Size[1];
  std::vector<float> bent(slice * image.Size[2]);
  image.Values.Copy(0, static_cast<std::ptrdiff_t>(bent.size()), bent.data());
  const Field field(image, options, executor);
  const float contrast = ContrastFraction * field.TypicalSlope() * static_cast<float>(image.Unit);
  const float sign = options.ObjectIsBright ? 1.f : -1.f;
  const float iso = static_cast<float>(options.IsoValue - image.Base);
  std::vector<std::vector<int>> pointsOf(static_cast<std::size_t>(image.Size[2]));
  for (std::size_t p = 0; p < this->Points.size(); ++p)
  {
    const AttractingPoint& point = this->Points[p];
    const auto slices = Range(image, 2, point.Position[2], ReachOf(image, point));
    for (int k = slices.first; k <= slices.second; ++k)
    {
      pointsOf[k].push_back(static_cast<int>(p));
    }
  }
  executor.For(pointsOf.size(), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> evidence;
      for (std::size_t k = begin; k < end; ++k)
      {
        if (pointsOf[k].empty())
        {
          continue;
        }
        evidence.assign(slice, 0.f);
        for (int p : pointsOf[k])
        {
          this->AddPoint(image, this->Points[p], static_cast<int>(k), evidence);
        }
        float* values = bent.data() + k * slice;
        for (std::size_t i = 0; i < slice; ++i)
        {
          if (evidence[i] > 0.f)
          {
            const float value = sign * (values[i] - iso);
            const float e = 1.f - std::exp(-Sharpness * evidence[i]);
            values[i] += sign * e * (2.f * std::max(-value, 0.f) + contrast);
          }
        }
      }
    });
  return bent;
}
}

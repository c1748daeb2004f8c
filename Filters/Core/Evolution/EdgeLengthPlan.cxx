// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgeLengthPlan.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Surface/SizingField.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace volumic
{
namespace
{
/** Range of delta_h / U_h (eq. 7). */
constexpr double LeastRatio = SizingField::LeastSamplingRatio;
constexpr double MostRatio = 1.;
/**
 * Factors between two levels that one division can follow. The range of the ratio spans
 * 2.5 / sqrt 3 = 1.443, so there is no gap between the lengths of consecutive levels.
 */
constexpr double LeastFactor = SizingField::LongestEdgeInDelta / SizingField::VoxelDiagonal - 1e-3;
constexpr double MostFactor = 1.99;
/** Mean edge lengths in units of level 0: shortest of level -1, longest of other levels. */
constexpr double ShortestInUnits = MeanEdgeInDelta * LeastRatio / MostFactor;
constexpr double LongestInUnits = MeanEdgeInDelta * MostRatio;

void CheckLength(double edgeLength)
{
  if (!(edgeLength > 0.) || !std::isfinite(edgeLength))
  {
    ThrowInvalidArgument("Edge Length is ", edgeLength, "; it must be 0 (automatic) or a length.");
  }
}

double RatioOf(const EdgeLengthPreferences& preferences)
{
  return std::clamp(preferences.SamplingRatio, LeastRatio, MostRatio);
}

/** @param delta in U_0 @param last the coarsest level */
EdgeLengthPlan PlanOf(double delta, int last, const EdgeLengthPreferences& preferences)
{
  const double preferred = preferences.Pyramid.ReductionFactor;
  const double ratio = RatioOf(preferences);
  const auto levels = [](double scale, double factor)
  { return std::log(scale) / std::log(factor); };
  int level = -1;
  double most = MostFactor;
  if (delta >= LeastRatio)
  {
    const double finest = std::ceil(levels(delta / MostRatio, MostFactor));
    const double coarsest = std::floor(levels(delta / LeastRatio, LeastFactor));
    const double nearest =
      std::round(levels(delta / ratio, std::clamp(preferred, LeastFactor, MostFactor)));
    level = static_cast<int>(std::max(finest, std::min({ nearest, coarsest, double(last) })));
    if (level == 0)
    {
      return { 0, preferred, delta };
    }
    // The image must be large enough for this level with the adjusted factor.
    most = std::min(most, std::pow(preferred, static_cast<double>(last) / level));
  }
  const double t = std::min(std::max(std::pow(delta / ratio, 1. / level), LeastFactor), most);
  return { level, t, std::clamp(delta / std::pow(t, level), LeastRatio, MostRatio) };
}
}

EdgeLengthPlan PlanEdgeLength(double edgeLength, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences)
{
  CheckLength(edgeLength);
  const std::vector<LevelGeometry> levels = PlanPyramid(size, spacing, preferences.Pyramid);
  const double unit = levels.front().Unit;
  const double shortest = ShortestInUnits * unit;
  const double longest = LongestInUnits * levels.back().Unit;
  if (!(edgeLength >= shortest && edgeLength <= longest))
  {
    ThrowInvalidArgument("Edge Length is ", edgeLength,
      ", but edges of this image can have mean lengths of ", shortest, " to ", longest,
      edgeLength < shortest
        ? ". Resample the image more finely, or give a longer one."
        : ". Give a shorter one, or allow coarser levels by Minimum Level Size.");
  }
  return PlanOf(
    edgeLength / MeanEdgeInDelta / unit, static_cast<int>(levels.size()) - 1, preferences);
}

EdgeLengthPlan PlanEdgeLength(
  double edgeLength, const std::vector<double>& units, const EdgeLengthPreferences& preferences)
{
  CheckLength(edgeLength);
  const double delta = edgeLength / MeanEdgeInDelta;
  if (delta < LeastRatio * units[0] && edgeLength >= ShortestInUnits * units[0])
  {
    return PlanOf(delta / units[0], 0, preferences);
  }
  const double unit = delta / RatioOf(preferences);
  const auto nearest = std::min_element(units.begin(), units.end(),
    [unit](double a, double b)
    { return std::abs(std::log(a / unit)) < std::abs(std::log(b / unit)); });
  const double ratio = delta / *nearest;
  if (ratio >= LeastRatio && ratio <= MostRatio)
  {
    return { static_cast<int>(nearest - units.begin()), preferences.Pyramid.ReductionFactor,
      ratio };
  }
  std::string possible = Join(ShortestInUnits * units[0], " to ", LongestInUnits * units[0]);
  for (std::size_t level = 1; level < units.size(); ++level)
  {
    possible += Join(level + 1 < units.size() ? ", " : " or ",
      MeanEdgeInDelta * LeastRatio * units[level], " to ", LongestInUnits * units[level]);
  }
  ThrowInvalidArgument("Edge Length is ", edgeLength,
    ", but with the levels of this pyramid edges can have mean "
    "lengths of ",
    possible, ". Give one of these, or the image instead of its pyramid.");
}
}

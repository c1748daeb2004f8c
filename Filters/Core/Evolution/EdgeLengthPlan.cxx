// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Evolution/EdgeLengthPlan.h"

#include "Core/Common/Refuse.h"
#include "Core/Surface/SizingField.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace volumic
{
namespace
{
/** Eq. (7): delta_h / U_h. */
constexpr double LeastRatio = SizingField::LeastSamplingRatio;
constexpr double MostRatio = 1.;
/**
 * Factors between two levels that a single division follows well: the range of the ratio spans
 * 2.5 / sqrt 3 = 1.443, so these leave no gap between the lengths of one level and the next.
 */
constexpr double LeastFactor =
  SizingField::LongestEdgeInDelta / SizingField::VoxelDiagonal - 1e-3;
constexpr double MostFactor = 1.99;

struct Candidate
{
  EdgeLengthPlan Plan;
  double Cost = 0.;
};

/** What computed ratios and factors may be outside their bounds by. */
constexpr double Rounding = 1e-9;
/** Levels from this one on are not looked at: no image has as many. */
constexpr int MaximumLevel = 40;
/** Steps in which the longest possible length is searched, and how far, in the shortest. */
constexpr double LengthStep = 1.01;
constexpr double SearchedLengths = 1e6;

/** Of the factor, beside 1 of the ratio, which LevelTask::MeanEdgeLength may still have to change. */
constexpr double WeightOfFactor = 0.25;

/**
 * The best factor and ratio of a level: ratio * factor^level = delta (in U_0). Without bounds the
 * weighted sum of squares of the two logarithms over what is preferred is least where each has the
 * share of what is missing below.
 */
std::optional<Candidate> BestOf(
  int level, double delta, double factor, const EdgeLengthPreferences& preferences)
{
  const double preferredRatio = std::clamp(preferences.SamplingRatio, LeastRatio, MostRatio);
  const double missing = std::log(delta / (preferredRatio * std::pow(factor, level)));
  const double share = missing / (WeightOfFactor + static_cast<double>(level) * level);
  const auto ratioFor = [&](double t) { return delta / std::pow(t, level); };
  double t = std::clamp(factor * std::exp(level * share), LeastFactor, MostFactor);
  double ratio = ratioFor(t);
  if (level != 0 && !(ratio >= LeastRatio && ratio <= MostRatio))
  {
    ratio = std::clamp(ratio, LeastRatio, MostRatio);
    t = std::pow(delta / ratio, 1. / level);
  }
  if (!(ratio >= LeastRatio - Rounding && ratio <= MostRatio + Rounding) ||
    !(level == 0 || (t >= LeastFactor - Rounding && t <= MostFactor + Rounding)))
  {
    return std::nullopt;
  }
  Candidate candidate;
  candidate.Plan = { level, level == 0 ? factor : t, std::clamp(ratio, LeastRatio, MostRatio) };
  candidate.Cost =
    WeightOfFactor * std::pow(std::log(candidate.Plan.ReductionFactor / factor), 2) +
    std::pow(std::log(candidate.Plan.SamplingRatio / preferredRatio), 2);
  return candidate;
}

void CheckLength(double edgeLength)
{
  if (!(edgeLength > 0.) || !std::isfinite(edgeLength))
  {
    Refuse("Edge Length is ", edgeLength, "; it must be 0 (automatic) or a length.");
  }
}

double SmallestUnit(const LevelSize& size, const std::array<double, 3>& spacing)
{
  PyramidOptions only;
  only.NumberOfLevels = 1;
  return PlanPyramid(size, spacing, only)[0].Unit;
}

/** Null where no level gives this delta (in U_0). */
std::optional<EdgeLengthPlan> PlanFor(double delta, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences)
{
  std::optional<Candidate> best;
  for (int level = -1; level < MaximumLevel; ++level)
  {
    const std::optional<Candidate> candidate =
      BestOf(level, delta, preferences.Pyramid.ReductionFactor, preferences);
    if (!candidate || (best && best->Cost <= candidate->Cost))
    {
      continue;
    }
    if (level > 0)
    {
      PyramidOptions pyramid = preferences.Pyramid;
      pyramid.ReductionFactor = candidate->Plan.ReductionFactor;
      if (pyramid.NumberOfLevels > MaximumNumberOfLevels(size, pyramid.ReductionFactor) ||
        level >= static_cast<int>(PlanPyramid(size, spacing, pyramid).size()))
      {
        continue;
      }
    }
    best = candidate;
  }
  return best ? std::optional<EdgeLengthPlan>(best->Plan) : std::nullopt;
}
}

EdgeLengthPlan PlanEdgeLength(double edgeLength, const LevelSize& size,
  const std::array<double, 3>& spacing, const EdgeLengthPreferences& preferences)
{
  CheckLength(edgeLength);
  const double unit = SmallestUnit(size, spacing);
  const auto planOf = [&](double length)
  { return PlanFor(length / MeanEdgeInDelta / unit, size, spacing, preferences); };
  if (const std::optional<EdgeLengthPlan> plan = planOf(edgeLength))
  {
    return *plan;
  }
  const double shortest = MeanEdgeInDelta * LeastRatio / MostFactor * unit;
  // By small steps: what is possible ends where the image is too small for another level.
  double longest = shortest;
  for (double length = shortest; length < SearchedLengths * shortest; length *= LengthStep)
  {
    longest = planOf(length) ? length : longest;
  }
  Refuse("Edge Length is ", edgeLength, ", but edges of this image can have mean lengths of ",
    shortest, " to ", longest,
    edgeLength < shortest
      ? ". Resample the image more finely, or give a longer one."
      : ". Give a shorter one, or allow coarser levels by Minimum Level Size.");
}

EdgeLengthPlan PlanEdgeLength(
  double edgeLength, const std::vector<double>& units, const EdgeLengthPreferences& preferences)
{
  CheckLength(edgeLength);
  const double delta = edgeLength / MeanEdgeInDelta;
  const double preferredRatio = std::clamp(preferences.SamplingRatio, LeastRatio, MostRatio);
  EdgeLengthPlan plan;
  plan.ReductionFactor = preferences.Pyramid.ReductionFactor;
  for (int level = 0; level < static_cast<int>(units.size()); ++level)
  {
    const double ratio = delta / units[level];
    if (ratio >= LeastRatio && ratio <= MostRatio &&
      (plan.SamplingRatio == 0. ||
        std::abs(std::log(ratio / preferredRatio)) <
          std::abs(std::log(plan.SamplingRatio / preferredRatio))))
    {
      plan.FinestLevel = level;
      plan.SamplingRatio = ratio;
    }
  }
  if (plan.SamplingRatio > 0.)
  {
    return plan;
  }
  if (const auto finer =
        BestOf(-1, delta / units[0], preferences.Pyramid.ReductionFactor, preferences))
  {
    return finer->Plan;
  }
  std::string possible = Join(MeanEdgeInDelta * LeastRatio / MostFactor * units[0], " to ",
    MeanEdgeInDelta * units[0]);
  for (std::size_t level = 1; level < units.size(); ++level)
  {
    possible += Join(level + 1 < units.size() ? ", " : " or ",
      MeanEdgeInDelta * LeastRatio * units[level], " to ", MeanEdgeInDelta * units[level]);
  }
  Refuse("Edge Length is ", edgeLength, ", but with the levels of this pyramid edges can have mean "
    "lengths of ", possible, ". Give one of these, or the image instead of its pyramid.");
}
}

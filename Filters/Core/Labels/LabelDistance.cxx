// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelDistance.h"

#include "Core/Labels/BoundaryGaussian.h"
#include "Core/Labels/LabelSides.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
namespace
{
/** Where the Gaussian loses voxels, one that is narrower by this factor takes its place, */
constexpr double NarrowerBy = 0.7071067811865476;
/** until it is as narrow as this, in smallest distances of voxels, */
constexpr double LeastSigma = 0.95;
/** fading out from them with this one. */
constexpr double FadingSigma = 1.25;

/** The quantiles of the normal distribution, from a table: the same bits on any machine. */
class NormalQuantile
{
public:
  static const NormalQuantile& Table()
  {
    static const NormalQuantile table;
    return table;
  }

  float At(float share) const
  {
    const float place = std::clamp(share, 0.f, 1.f) * Steps;
    const int step = std::min(static_cast<int>(place), Steps - 1);
    const float* values = this->Values.data() + step;
    return values[0] + (place - static_cast<float>(step)) * (values[1] - values[0]);
  }

private:
  static constexpr int Steps = 4096;

  NormalQuantile()
  {
    for (int i = 0; i <= Steps; ++i)
    {
      const double share = std::clamp(i / static_cast<double>(Steps), 1e-5, 1. - 1e-5);
      double low = -5.;
      double high = 5.;
      for (int halving = 0; halving < 50; ++halving)
      {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.)) < share ? low : high) = middle;
      }
      this->Values[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * (low + high));
    }
  }

  std::array<float, Steps + 1> Values;
};

/** Makes the distance of one object. */
class DistanceMaker
{
public:
  DistanceMaker(const LabelMap& map, int object, const BoundaryRows& rows, LabelField& field,
    Executor& executor)
    : Map(map), Sides(map, object), Rows(rows), Field(field), Threads(executor)
  {
  }

  /**
   * With less smoothing where voxels would be lost: for what is held to all voxels once the volume
   * has been made up for, else before, as a thin part may be made too thick by that.
   */
  void Make(double sigma, bool isHeld)
  {
    this->MakeWith(sigma, isHeld);
    LargeVector<unsigned char> lost(this->Field.Values.size(), 0);
    for (double narrower = sigma * NarrowerBy; narrower > LeastSigma && this->FindLost(lost);
         narrower *= NarrowerBy)
    {
      this->MakeNarrower(narrower, isHeld, lost);
    }
    if (!isHeld)
    {
      this->CorrectVolume(sigma, false);
    }
  }

private:
  std::array<double, 3> InVoxels(double sigma) const
  {
    std::array<double, 3> inVoxels;
    for (int axis = 0; axis < 3; ++axis)
    {
      inVoxels[axis] = sigma / this->Map.Spacing[axis];
    }
    return inVoxels;
  }

  void MakeWith(double ofGaussian, bool isCorrected)
  {
    const auto sigma = static_cast<float>(ofGaussian);
    BoundaryGaussian gaussian(this->Rows, this->InVoxels(ofGaussian));
    LargeVector<float> smooth(this->Field.Values.size());
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->Sides.CopyMembership(i, j, k, count, values); },
      smooth, this->Threads);
    this->ForValues(smooth,
      [sigma](float& value, float share)
      {
        value =
          std::clamp(sigma * NormalQuantile::Table().At(share), -LabelField::Far, LabelField::Far);
      });
    if (isCorrected)
    {
      this->CorrectVolume(ofGaussian, true);
    }
  }

  /** Step 2. @param isHeld as in Make(): what makes a thin part too thick is taken back */
  void CorrectVolume(double ofGaussian, bool isHeld)
  {
    const auto sigma = static_cast<float>(ofGaussian);
    BoundaryGaussian gaussian(this->Rows, this->InVoxels(ofGaussian));
    LargeVector<float> missing(this->Field.Values.size());
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->CopyMissingVolume(i, j, k, count, values); },
      missing, this->Threads);
    const float perShare = sigma * 2.5066283f; // sqrt(2 pi)
    LargeVector<float> boundary(isHeld ? 0 : missing.size());
    if (!isHeld)
    {
      gaussian.Smooth([this](int i, int j, int k, int count, float* values)
        { this->CopyBoundary(i, j, k, count, values); },
        boundary, this->Threads);
    }
    for (std::size_t v = 0; v < missing.size(); ++v)
    {
      const bool isThin = !isHeld && boundary[v] * perShare > 1.f;
      missing[v] *= isThin ? 1.f / boundary[v] : perShare;
    }
    this->ForValues(missing,
      [](float& value, float more)
      { value = std::clamp(value + more, -LabelField::Far, LabelField::Far); });
  }

  /** 1 where a small change of the field changes the volume that it has inside. */
  void CopyBoundary(int i, int j, int k, int count, float* values) const
  {
    std::fill(values, values + count, 0.f);
    this->ForField(i, j, k, count, values,
      [](float& value, float field) { value = std::abs(field) < 0.5f ? 1.f : 0.f; });
  }

  /** The membership less what of each voxel is inside by the field; off the rows there is none. */
  void CopyMissingVolume(int i, int j, int k, int count, float* values) const
  {
    this->Sides.CopyMembership(i, j, k, count, values);
    this->ForField(i, j, k, count, values,
      [](float& value, float field) { value -= std::clamp(field + 0.5f, 0.f, 1.f); });
  }

  /** About the voxels that are lost, fading into what there is. */
  void MakeNarrower(double sigma, bool isCorrected, const LargeVector<unsigned char>& lost)
  {
    const VoxelBox& box = this->Field.Box;
    LargeVector<float> fading(this->Field.Values.size());
    BoundaryGaussian(this->Rows, this->InVoxels(FadingSigma))
      .Smooth(
        [&](int i, int j, int k, int count, float* values)
        {
          for (int x = 0; x < count; ++x)
          {
            const bool isLost = box.Contains({ i + x, j, k }) &&
              lost[static_cast<std::size_t>(box.NumberOf(i + x, j, k))] != 0;
            values[x] = isLost ? 1.f : 0.f;
          }
        },
        fading, this->Threads);
    const double cubed = FadingSigma * FadingSigma * FadingSigma;
    const double voxel = this->Map.Spacing[0] * this->Map.Spacing[1] * this->Map.Spacing[2];
    const auto perShare =
      static_cast<float>(15.749610 * cubed / voxel); // (2 pi)^1.5: 1 at one alone
    const LargeVector<float> before = this->Field.Values;
    this->MakeWith(sigma, isCorrected);
    for (std::size_t v = 0; v < before.size(); ++v)
    {
      const float share = std::min(1.f, perShare * fading[v]);
      this->Field.Values[v] = before[v] + share * (this->Field.Values[v] - before[v]);
    }
  }

  /** @return whether there are any */
  bool FindLost(LargeVector<unsigned char>& lost) const
  {
    std::atomic<bool> isAny{ false };
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        unsigned char* row = lost.data() + this->Field.Box.NumberOf(i, j, k);
        for (int x = 0; x < count; ++x)
        {
          row[x] = this->Sides.IsLost(this->Field, i + x, j, k) ? 1 : 0;
          if (row[x] != 0)
          {
            isAny = true;
          }
        }
      });
    return isAny;
  }

  /** Calls change(value, other) for each voxel of the rows. */
  template <typename Change>
  void ForValues(const LargeVector<float>& others, Change&& change)
  {
    this->Rows.For(this->Threads,
      [&](int i, int j, int k, int count)
      {
        const std::int64_t first = this->Field.Box.NumberOf(i, j, k);
        float* values = this->Field.Values.data() + first;
        const float* other = others.data() + first;
        for (int x = 0; x < count; ++x)
        {
          change(values[x], other[x]);
        }
      });
  }

  /** Calls change(value, field) for those of `count` values that are in the box. */
  template <typename Change>
  void ForField(int i, int j, int k, int count, float* values, Change&& change) const
  {
    const VoxelBox& box = this->Field.Box;
    const int first = std::max(i, box.First[0]);
    const int end = std::min(i + count, box.End[0]);
    const float* row = this->Field.Values.data() + box.NumberOf(first, j, k);
    for (int x = first; x < end; ++x)
    {
      change(values[x - i], row[x - first]);
    }
  }

  const LabelMap& Map;
  LabelSides Sides;
  const BoundaryRows& Rows;
  LabelField& Field;
  Executor& Threads;
};
}

void MakeLabelDistance(const LabelMap& map, int object, const BoundaryRows& rows,
  const LabelFieldOptions& options, LabelField& field, Executor& executor)
{
  DistanceMaker(map, object, rows, field, executor).Make(options.Sigma, options.Tolerance == 0.);
}
}

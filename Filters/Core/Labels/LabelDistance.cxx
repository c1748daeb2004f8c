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
/** until it has become so narrow that it moves hardly anything, in smallest distances of voxels, */
static const double LeastSigma = getenv("LSG") ? atof(getenv("LSG")) : 0.95;
/** fading out from them with this one. */
constexpr double FadingSigma = 1.25;
/** As a share; where there is less, no boundary is near, and its volume is out of reach. */
constexpr float LeastBoundary = 1e-6f;

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

  /** With less smoothing where voxels would be lost. */
  void Make(double sigma)
  {
    this->MakeWith(sigma);
    LargeVector<unsigned char> lost(this->Field.Values.size(), 0);
    for (double narrower = sigma * NarrowerBy; narrower > LeastSigma && this->FindLost(lost);
         narrower *= NarrowerBy)
    {
      this->MakeNarrower(narrower, lost);
    }
    this->CorrectVolume(sigma);
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

  void MakeWith(double ofGaussian)
  {
    const auto sigma = static_cast<float>(ofGaussian);
    BoundaryGaussian gaussian(this->Rows, this->InVoxels(ofGaussian));
    LargeVector<float> smooth(this->Field.Values.size());
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->Sides.CopyMembership(i, j, k, count, values); }, smooth, this->Threads);
    this->ForValues(smooth, [sigma](float& value, float share)
      { value = std::clamp(sigma * NormalQuantile::Table().At(share), -LabelField::Far,
          LabelField::Far); });
  }

  void CorrectVolume(double ofGaussian)
  {
    const auto sigma = static_cast<float>(ofGaussian);
    BoundaryGaussian gaussian(this->Rows, this->InVoxels(ofGaussian));
    LargeVector<float> smooth(this->Field.Values.size());
    LargeVector<float> boundary(this->Field.Values.size());
    const float most = sigma * 2.5066283f; // sqrt(2 pi): at a flat boundary alone
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->CopyBoundary(i, j, k, count, values); }, boundary, this->Threads);
    gaussian.Smooth([this](int i, int j, int k, int count, float* values)
      { this->CopyMissingVolume(i, j, k, count, values); }, smooth, this->Threads);
    for (std::size_t v = 0; v < smooth.size(); ++v)
    {
      smooth[v] *= std::min(most, 1.f / std::max(boundary[v], LeastBoundary));
    }
    this->ForValues(smooth, [](float& value, float missing)
      { value = std::clamp(value + missing, -LabelField::Far, LabelField::Far); });
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
  void MakeNarrower(double sigma, const LargeVector<unsigned char>& lost)
  {
    const VoxelBox& box = this->Field.Box;
    LargeVector<float> fading(this->Field.Values.size());
    BoundaryGaussian(this->Rows, this->InVoxels(FadingSigma)).Smooth(
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
    const auto perShare = static_cast<float>(15.749610 * cubed / voxel); // (2 pi)^1.5: 1 at one alone
    const LargeVector<float> before = this->Field.Values;
    this->MakeWith(sigma);
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

void MakeLabelDistance(const LabelMap& map, int object, const BoundaryRows& rows, double sigma,
  LabelField& field, Executor& executor)
{
  DistanceMaker(map, object, rows, field, executor).Make(sigma);
}
}

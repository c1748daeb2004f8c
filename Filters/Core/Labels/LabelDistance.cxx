// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelDistance.h"

#include "Core/Labels/BoundaryGaussian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace volumic
{
namespace
{
/** Factor by which sigma is repeatedly reduced near missed voxels. */
constexpr double NarrowerBy = 0.7071067811865476;
/** Least sigma of a narrower Gaussian, in the smallest voxel spacing. */
constexpr double LeastSigma = 0.95;
/** Sigma of the Gaussian that blends the narrower field with the field around it. */
constexpr double FadingSigma = 1.25;

/** Quantiles of the normal distribution, tabulated: results are bit-identical on all machines. */
class NormalQuantile
{
public:
  static const NormalQuantile& Table()
  {
    static const NormalQuantile table;
    return table;
  }

  float At(float probability) const
  {
    const float position = std::clamp(probability, 0.f, 1.f) * Steps;
    const int step = std::min(static_cast<int>(position), Steps - 1);
    const float* values = this->Values.data() + step;
    return values[0] + (position - static_cast<float>(step)) * (values[1] - values[0]);
  }

private:
  static constexpr int Steps = 4096;

  NormalQuantile()
  {
    for (int i = 0; i <= Steps; ++i)
    {
      const double probability = std::clamp(i / static_cast<double>(Steps), 1e-5, 1. - 1e-5);
      double low = -5.;
      double high = 5.;
      for (int halving = 0; halving < 50; ++halving)
      {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.)) < probability ? low : high) = middle;
      }
      this->Values[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * (low + high));
    }
  }

  std::array<float, Steps + 1> Values;
};

class DistanceMaker
{
public:
  DistanceMaker(const LabelSides& sides, const std::array<double, 3>& spacing, LabelField& field,
    Executor& executor)
    : Sides(sides), Varying(sides.FindChanges(0)), Spacing(spacing), Field(field), Threads(executor)
  {
  }

  /**
   * Compute the distance, with a narrower Gaussian near missed voxels.
   * @param isConstrained whether all voxels are constrained. The volume is then corrected before
   *                      missed voxels are searched. Otherwise it is corrected at the end, as the
   *                      correction may thicken thin parts.
   */
  void Make(double sigma, bool isConstrained)
  {
    const VoxelBits& rows = this->Field.Rows;
    this->MakeWith(rows, rows, sigma, isConstrained);
    for (double narrower = sigma * NarrowerBy; narrower > LeastSigma; narrower *= NarrowerBy)
    {
      const VoxelBits missed = this->Sides.FindMissed(this->Field, rows, this->Threads);
      if (missed.IsEmpty())
      {
        break;
      }
      this->MakeNarrower(rows, missed, narrower, isConstrained);
    }
    if (!isConstrained)
    {
      this->CorrectVolume(rows, sigma, false);
    }
  }

private:
  std::array<double, 3> InVoxels(double sigma) const
  {
    std::array<double, 3> inVoxels;
    for (int axis = 0; axis < 3; ++axis)
    {
      inVoxels[axis] = sigma / this->Spacing[axis];
    }
    return inVoxels;
  }

  std::array<int, 3> ReachOf(double sigma) const
  {
    std::array<int, 3> reach;
    for (int axis = 0; axis < 3; ++axis)
    {
      reach[axis] = static_cast<int>(std::ceil(3. * sigma / this->Spacing[axis]));
    }
    return reach;
  }

  float* At(LargeVector<float>& values, int i, int j, int k) const
  {
    return values.data() + this->Field.Box.NumberOf(i, j, k);
  }

  /** @param corrected subset of the rows in which the volume is corrected, if isCorrected */
  void MakeWith(
    const VoxelBits& rows, const VoxelBits& corrected, double gaussianSigma, bool isCorrected)
  {
    const auto sigma = static_cast<float>(gaussianSigma);
    const NormalQuantile& quantiles = NormalQuantile::Table();
    this->Gaussian.Smooth(
      rows, this->Varying, this->InVoxels(gaussianSigma),
      [this](int i, int j, int k, int count, float* values)
      { this->Sides.CopyMembership(i, j, k, count, values); },
      [&](int i, int j, int k, int count, const float* smoothed)
      {
        float* values = this->At(this->Field.Values, i, j, k);
        for (int x = 0; x < count; ++x)
        {
          values[x] =
            std::clamp(sigma * quantiles.At(smoothed[x]), -LabelField::Far, LabelField::Far);
        }
      },
      this->Threads);
    if (isCorrected)
    {
      this->CorrectVolume(corrected, gaussianSigma, true);
    }
  }

  /** Run step 2. @param isConstrained if false, the correction is reduced at thin parts */
  void CorrectVolume(const VoxelBits& rows, double gaussianSigma, bool isConstrained)
  {
    const float scale = static_cast<float>(gaussianSigma) * 2.5066283f; // sqrt(2 pi)
    this->MissingVolume.resize(this->Field.Values.size());
    this->Gaussian.Smooth(
      rows, this->Field.Rows, this->InVoxels(gaussianSigma),
      [this](int i, int j, int k, int count, float* values)
      { this->CopyMissingVolume(i, j, k, count, values); },
      [&](int i, int j, int k, int count, const float* missing)
      {
        float* more = this->At(this->MissingVolume, i, j, k);
        std::transform(
          missing, missing + count, more, [scale](float volume) { return volume * scale; });
      },
      this->Threads);
    const auto add = [&](int i, int j, int k, int count, const float* boundary)
    {
      float* values = this->At(this->Field.Values, i, j, k);
      const float* more = this->At(this->MissingVolume, i, j, k);
      for (int x = 0; x < count; ++x)
      {
        const float divisor = boundary ? std::max(1.f, boundary[x] * scale) : 1.f;
        values[x] = std::clamp(values[x] + more[x] / divisor, -LabelField::Far, LabelField::Far);
      }
    };
    if (isConstrained)
    {
      rows.For(
        this->Threads, [&](int i, int j, int k, int count) { add(i, j, k, count, nullptr); });
      return;
    }
    this->Gaussian.Smooth(
      rows, this->Field.Rows, this->InVoxels(gaussianSigma),
      [this](int i, int j, int k, int count, float* values)
      { this->CopyBoundary(i, j, k, count, values); },
      add, this->Threads);
  }

  /** Write 1 where a small change of the field changes the enclosed volume, else 0. */
  void CopyBoundary(int i, int j, int k, int count, float* values) const
  {
    const float* field = this->At(this->Field.Values, i, j, k);
    for (int x = 0; x < count; ++x)
    {
      values[x] = std::abs(field[x]) < 0.5f ? 1.f : 0.f;
    }
  }

  /** Write the membership minus the fraction of each voxel that is inside; 0 outside the rows. */
  void CopyMissingVolume(int i, int j, int k, int count, float* values) const
  {
    this->Sides.CopyMembership(i, j, k, count, values);
    const float* field = this->At(this->Field.Values, i, j, k);
    for (int x = 0; x < count; ++x)
    {
      values[x] -= std::clamp(field[x] + 0.5f, 0.f, 1.f);
    }
  }

  /** Recompute the field near missed voxels with a smaller sigma, and blend it with the old one. */
  void MakeNarrower(const VoxelBits& rows, const VoxelBits& missed, double sigma, bool isCorrected)
  {
    const double cubed = FadingSigma * FadingSigma * FadingSigma;
    const double voxel = this->Spacing[0] * this->Spacing[1] * this->Spacing[2];
    const auto scale =
      static_cast<float>(15.749610 * cubed / voxel); // (2 pi)^1.5: weight 1 at a single voxel
    const VoxelBits near = rows & missed.Grown(this->ReachOf(FadingSigma)).InFours();
    LargeVector<float> values = this->Field.Values;
    this->MakeWith(isCorrected ? rows & near.Grown(this->ReachOf(sigma)).InFours() : near, near,
      sigma, isCorrected);
    values.swap(this->Field.Values);
    this->Gaussian.Smooth(
      near, missed.Grown(0, 1), this->InVoxels(FadingSigma),
      [&](int i, int j, int k, int count, float* smoothed)
      {
        for (int x = 0; x < count; ++x)
        {
          smoothed[x] = missed.Has(i + x, j, k) ? 1.f : 0.f;
        }
      },
      [&](int i, int j, int k, int count, const float* smoothed)
      {
        float* to = this->At(this->Field.Values, i, j, k);
        const float* narrow = this->At(values, i, j, k);
        for (int x = 0; x < count; ++x)
        {
          to[x] += std::min(1.f, scale * smoothed[x]) * (narrow[x] - to[x]);
        }
      },
      this->Threads);
  }

  const LabelSides& Sides;
  const VoxelBits Varying; ///< voxels whose membership differs from the next one along x
  const std::array<double, 3> Spacing;
  LabelField& Field;
  Executor& Threads;
  BoundaryGaussian Gaussian;
  LargeVector<float> MissingVolume; ///< smoothed missing volume
};
}

void MakeLabelDistance(const LabelSides& sides, const std::array<double, 3>& spacing,
  const LabelFieldOptions& options, LabelField& field, Executor& executor)
{
  DistanceMaker(sides, spacing, field, executor).Make(options.Sigma, options.Tolerance == 0.);
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/BoundaryGaussian.h"

#include "Core/Common/Lanes.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace volumic
{
namespace
{
/** Normalized weights of a symmetric Gaussian kernel, from the middle on. */
class Weights
{
public:
  explicit Weights(double sigma)
  {
    const int reach = static_cast<int>(std::ceil(3. * sigma));
    std::vector<double> weights = { 1. };
    double sum = 1.;
    for (int n = 1; n <= reach; ++n)
    {
      weights.push_back(std::exp(-0.5 * n * n / (sigma * sigma)));
      sum += 2. * weights.back();
    }
    std::transform(weights.begin(), weights.end(), std::back_inserter(this->Values),
      [sum](double weight) { return static_cast<float>(weight / sum); });
  }

  int Reach() const { return static_cast<int>(this->Values.size()) - 1; }

  /**
   * Write `count` weighted sums (a multiple of 4) of values at distance `stride`. There are
   * `before` values before and `after` values after the middle.
   */
  void Sum(
    const float* from, std::ptrdiff_t stride, int before, int after, int count, float* sums) const
  {
    int x = 0;
    for (; x + 2 * Lanes::Count <= count; x += 2 * Lanes::Count)
    {
      this->SumGroups<2>(from + x, stride, before, after, sums + x);
    }
    if (x < count)
    {
      this->SumGroups<1>(from + x, stride, before, after, sums + x);
    }
  }

private:
  template <int Groups>
  void SumGroups(const float* from, std::ptrdiff_t stride, int before, int after, float* sums) const
  {
    const int both = std::min({ before, after, this->Reach() });
    const int most = std::min(std::max(before, after), this->Reach());
    std::array<Lanes, Groups> sum;
    for (int g = 0; g < Groups; ++g)
    {
      sum[g] = Lanes(this->Values[0]) * Lanes::Load(from + g * Lanes::Count);
    }
    for (int n = 1; n <= both; ++n)
    {
      const Lanes weight(this->Values[static_cast<std::size_t>(n)]);
      for (int g = 0; g < Groups; ++g)
      {
        const float* at = from + g * Lanes::Count;
        sum[g] += weight * (Lanes::Load(at - n * stride) + Lanes::Load(at + n * stride));
      }
    }
    const std::ptrdiff_t longer = before < after ? stride : -stride;
    for (int n = both + 1; n <= most; ++n)
    {
      const Lanes weight(this->Values[static_cast<std::size_t>(n)]);
      for (int g = 0; g < Groups; ++g)
      {
        sum[g] += weight * Lanes::Load(from + g * Lanes::Count + n * longer);
      }
    }
    for (int g = 0; g < Groups; ++g)
    {
      sum[g].Store(sums + g * Lanes::Count);
    }
  }

  std::vector<float> Values;
};
}

void BoundaryGaussian::Smooth(const VoxelBits& rows, const VoxelBits& varying,
  const std::array<double, 3>& sigma, const Source& source, const Receiver& receive,
  Executor& executor)
{
  const VoxelBox& box = rows.Box();
  const std::array<Weights, 3> weights = { Weights(sigma[0]), Weights(sigma[1]),
    Weights(sigma[2]) };
  const VoxelBits beforeZ = rows.Grown(2, weights[2].Reach());
  const VoxelBits beforeY = beforeZ.Grown(1, weights[1].Reach());
  const VoxelBits changed = beforeY & varying.Grown(0, weights[0].Reach()).InFours();
  const auto count = static_cast<std::size_t>(box.Count());
  if (this->AlongXY.size() < count)
  {
    MakeZeroed(this->AlongXY, count);
  }
  const auto lengthX = static_cast<std::size_t>(box.Length(0));
  const std::size_t layer = lengthX * static_cast<std::size_t>(box.Length(1));
  const auto layers = static_cast<std::size_t>(box.Length(2));
  executor.For(layers, 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> alongX(layer);
      // Rows with a margin of zeros beyond the box.
      const int margin = (weights[0].Reach() + Lanes::Count - 1) / Lanes::Count * Lanes::Count;
      const std::size_t width = lengthX + 2 * static_cast<std::size_t>(margin);
      std::vector<float> sources(width * static_cast<std::size_t>(box.Length(1)), 0.f);
      const auto sourceAt = [&](int i, int j)
      {
        return sources.data() + margin + i - box.First[0] +
          width * static_cast<std::size_t>(j - box.First[1]);
      };
      for (std::size_t n = begin; n < end; ++n)
      {
        beforeY.ForLayer(static_cast<int>(n),
          [&](int i, int j, int k, int length)
          {
            const int first = std::max(box.First[0], i - margin);
            source(
              first, j, k, std::min(box.End[0], i + length + margin) - first, sourceAt(first, j));
            std::copy_n(sourceAt(i, j), length, alongX.data() + box.NumberOf(i, j, box.First[2]));
          });
        changed.ForLayer(static_cast<int>(n),
          [&](int i, int j, int, int length)
          {
            weights[0].Sum(sourceAt(i, j), 1, margin, margin, length,
              alongX.data() + box.NumberOf(i, j, box.First[2]));
          });
        beforeZ.ForLayer(static_cast<int>(n),
          [&](int i, int j, int k, int length)
          {
            weights[1].Sum(alongX.data() + box.NumberOf(i, j, box.First[2]),
              static_cast<std::ptrdiff_t>(lengthX), j - box.First[1], box.End[1] - 1 - j, length,
              this->AlongXY.data() + box.NumberOf(i, j, k));
          });
      }
    });
  executor.For(layers, 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> sums(lengthX);
      for (std::size_t n = begin; n < end; ++n)
      {
        rows.ForLayer(static_cast<int>(n),
          [&](int i, int j, int k, int length)
          {
            weights[2].Sum(this->AlongXY.data() + box.NumberOf(i, j, k),
              static_cast<std::ptrdiff_t>(layer), k - box.First[2], box.End[2] - 1 - k, length,
              sums.data());
            receive(i, j, k, length, sums.data());
          });
      }
    });
}
}

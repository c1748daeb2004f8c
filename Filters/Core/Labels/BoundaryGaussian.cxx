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
/** One side of a Gaussian, from the middle on, which with its mirror image adds up to 1. */
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
   * Writes `count` sums, a multiple of 4, of values that are `stride` apart, of which there are
   * `before` and `after` the middle.
   */
  void Sum(const float* from, std::ptrdiff_t stride, int before, int after, int count,
    float* sums) const
  {
    const int both = std::min({ before, after, this->Reach() });
    const int most = std::min(std::max(before, after), this->Reach());
    const std::ptrdiff_t longer = before < after ? stride : -stride;
    for (int x = 0; x < count; x += Lanes::Count)
    {
      const float* at = from + x;
      Lanes sum = Lanes(this->Values[0]) * Lanes::Load(at);
      for (int n = 1; n <= both; ++n)
      {
        sum += Lanes(this->Values[static_cast<std::size_t>(n)]) *
          (Lanes::Load(at - n * stride) + Lanes::Load(at + n * stride));
      }
      for (int n = both + 1; n <= most; ++n)
      {
        sum += Lanes(this->Values[static_cast<std::size_t>(n)]) * Lanes::Load(at + n * longer);
      }
      sum.Store(sums + x);
    }
  }

private:
  std::vector<float> Values;
};
}

void BoundaryGaussian::Smooth(const VoxelBits& rows, const std::array<double, 3>& sigma,
  const Source& source, const Receiver& receive, Executor& executor)
{
  const VoxelBox& box = rows.Box();
  const std::array<Weights, 3> weights = { Weights(sigma[0]), Weights(sigma[1]),
    Weights(sigma[2]) };
  const VoxelBits beforeZ = rows.Grown(2, weights[2].Reach());
  const VoxelBits beforeY = beforeZ.Grown(1, weights[1].Reach());
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
      // A whole group of four beyond the reach, as sources may be read in groups.
      const int reach = (weights[0].Reach() + 3) & ~3;
      std::vector<float> row(lengthX + 2 * static_cast<std::size_t>(reach), 0.f);
      std::vector<float> alongX(layer);
      for (std::size_t n = begin; n < end; ++n)
      {
        const auto smoothX = [&](int i, int j, int k, int length)
        {
          const int first = std::max(box.First[0], i - reach);
          const int last = std::min(box.End[0], i + length + reach);
          float* values = row.data() + reach - box.First[0];
          source(first, j, k, last - first, values + first);
          weights[0].Sum(values + i, 1, reach, reach, length,
            alongX.data() + box.NumberOf(i, j, box.First[2]));
        };
        beforeY.ForLayer(static_cast<int>(n), smoothX);
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

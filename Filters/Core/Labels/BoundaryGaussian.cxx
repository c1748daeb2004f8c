// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/BoundaryGaussian.h"

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** Those of one side, which with their mirror images add up to 1. */
std::vector<float> WeightsOf(double sigma)
{
  const int reach = static_cast<int>(std::ceil(3. * sigma));
  std::vector<double> weights = { 1. };
  double sum = 1.;
  for (int n = 1; n <= reach; ++n)
  {
    weights.push_back(std::exp(-0.5 * n * n / (sigma * sigma)));
    sum += 2. * weights.back();
  }
  std::vector<float> all;
  std::transform(weights.begin(), weights.end(), std::back_inserter(all),
    [sum](double weight) { return static_cast<float>(weight / sum); });
  return all;
}

int ReachOf(const std::vector<float>& weights)
{
  return static_cast<int>(weights.size()) - 1;
}
}

BoundaryGaussian::BoundaryGaussian(const BoundaryRows& rows, const std::array<double, 3>& sigma)
  : Rows(&rows)
  , BeforeZ(rows.Grown(2, static_cast<int>(std::ceil(3. * sigma[2]))))
  , BeforeY(this->BeforeZ.Grown(1, static_cast<int>(std::ceil(3. * sigma[1]))))
  , Weights{ WeightsOf(sigma[0]), WeightsOf(sigma[1]), WeightsOf(sigma[2]) }
  , AlongX(static_cast<std::size_t>(rows.Box().Count()))
  , AlongY(static_cast<std::size_t>(rows.Box().Count()))
{
}

void BoundaryGaussian::Smooth(
  const Source& source, LargeVector<float>& result, Executor& executor)
{
  this->SmoothAlongX(source, executor);
  this->SmoothAcross(1, this->BeforeZ, this->AlongX, this->AlongY, executor);
  this->SmoothAcross(2, *this->Rows, this->AlongY, result, executor);
}

void BoundaryGaussian::SmoothAlongX(const Source& source, Executor& executor)
{
  const std::vector<float>& weights = this->Weights[0];
  const int reach = ReachOf(weights);
  const VoxelBox& box = this->Rows->Box();
  executor.For(static_cast<std::size_t>(this->BeforeY.NumberOfLayers()), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> row(static_cast<std::size_t>(box.Length(0) + 2 * reach));
      for (std::size_t layer = begin; layer < end; ++layer)
      {
        this->BeforeY.ForLayer(static_cast<int>(layer),
          [&](int i, int j, int k, int count)
          {
            source(i - reach, j, k, count + 2 * reach, row.data());
            float* to = this->AlongX.data() + box.NumberOf(i, j, k);
            const float* from = row.data() + reach;
            for (int x = 0; x < count; ++x)
            {
              to[x] = weights[0] * from[x];
            }
            for (int n = 1; n <= reach; ++n)
            {
              const float weight = weights[static_cast<std::size_t>(n)];
              for (int x = 0; x < count; ++x)
              {
                to[x] += weight * (from[x - n] + from[x + n]);
              }
            }
          });
      }
    });
}

void BoundaryGaussian::SmoothAcross(int axis, const BoundaryRows& rows,
  const LargeVector<float>& from, LargeVector<float>& to, Executor& executor) const
{
  const std::vector<float>& weights = this->Weights[static_cast<std::size_t>(axis)];
  const int reach = ReachOf(weights);
  const VoxelBox& box = this->Rows->Box();
  rows.For(executor,
    [&](int i, int j, int k, int count)
    {
      float* sum = to.data() + box.NumberOf(i, j, k);
      std::array<int, 3> at = { i, j, k };
      const int middle = at[axis];
      const float* centre = from.data() + box.NumberOf(i, j, k);
      for (int x = 0; x < count; ++x)
      {
        sum[x] = weights[0] * centre[x];
      }
      for (int n = 1; n <= reach; ++n)
      {
        for (const int other : { middle - n, middle + n })
        {
          if (other < box.First[axis] || other >= box.End[axis])
          {
            continue; // Nothing of the object is there.
          }
          at[axis] = other;
          const float* row = from.data() + box.NumberOf(at[0], at[1], at[2]);
          const float weight = weights[static_cast<std::size_t>(n)];
          for (int x = 0; x < count; ++x)
          {
            sum[x] += weight * row[x];
          }
        }
      }
    });
}
}

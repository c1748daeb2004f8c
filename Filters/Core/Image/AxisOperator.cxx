// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/AxisOperator.h"

#include "Core/Common/ThrowInvalidArgument.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace volumic
{
namespace
{
/** w of eq. 5. */
constexpr std::array<double, 5> Kernel = { 1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16. };

/** Weights of one output voxel, before padding. */
struct Band
{
  std::int64_t First = 0;
  std::int64_t Last = 0;
  std::array<double, AxisOperator::MaximumNumberOfTaps> Weight{};
};

/** Position along the axis: lower voxel, and weight of the upper one. */
struct Sample
{
  std::int64_t Voxel;
  double Fraction;
};

Sample Locate(double position, std::int64_t size)
{
  const double last = static_cast<double>(size - 1);
  const double inside = std::clamp(position, 0.0, last);
  const auto voxel = static_cast<std::int64_t>(std::floor(inside));
  return { voxel, inside - static_cast<double>(voxel) };
}

Band MakeBand(double centre, double offset, std::int64_t size)
{
  std::array<Sample, 5> samples;
  Band band;
  band.First = size;
  for (int m = -2; m <= 2; ++m)
  {
    Sample& sample = samples[m + 2];
    sample = Locate(centre + m * offset, size);
    band.First = std::min(band.First, sample.Voxel);
    band.Last = std::max(band.Last, sample.Voxel + (sample.Fraction > 0.0 ? 1 : 0));
  }
  for (int m = 0; m < 5; ++m)
  {
    const auto tap = static_cast<std::size_t>(samples[m].Voxel - band.First);
    band.Weight[tap] += Kernel[m] * (1.0 - samples[m].Fraction);
    if (samples[m].Fraction > 0.0)
    {
      band.Weight[tap + 1] += Kernel[m] * samples[m].Fraction;
    }
  }
  return band;
}
}

AxisOperator::AxisOperator(std::int64_t inputSize, std::int64_t outputSize, double offset)
{
  if (inputSize < 1 || outputSize < 1 || !(offset >= 0.0 && offset <= 1.0))
  {
    ThrowInvalidArgument("AxisOperator: ", inputSize, " to ", outputSize,
      " voxels with an offset of ", offset,
      " voxels; sizes must be at least 1, the offset in [0, 1].");
  }
  std::vector<Band> bands(outputSize);
  const double step = static_cast<double>(inputSize) / static_cast<double>(outputSize);
  for (std::int64_t i = 0; i < outputSize; ++i)
  {
    bands[i] = MakeBand(static_cast<double>(i) * step, offset, inputSize);
    this->Taps = std::max(this->Taps, static_cast<int>(bands[i].Last - bands[i].First) + 1);
  }

  this->FirstVoxel.resize(outputSize);
  this->Weight.assign(outputSize * this->Taps, 0.0);
  for (std::int64_t i = 0; i < outputSize; ++i)
  {
    // Short bands at the upper border start earlier, so that no tap lies past the last voxel.
    const std::int64_t first = std::min(bands[i].First, inputSize - this->Taps);
    const std::int64_t shift = bands[i].First - first;
    this->FirstVoxel[i] = first;
    const std::int64_t length = bands[i].Last - bands[i].First + 1;
    std::copy_n(bands[i].Weight.begin(), length, this->Weight.begin() + i * this->Taps + shift);
  }
}
}

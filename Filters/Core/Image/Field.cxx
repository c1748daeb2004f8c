// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/Field.h"

#include "Core/Common/Refuse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace volumic
{
namespace
{
/** Voxels that one thread looks through at a time for the extreme values. */
constexpr std::size_t RangeBlock = 1 << 16;
/** Blocks of them under which a chunk is not worth a thread. */
constexpr std::size_t RangeGrain = 4;
/** The typical slope is measured on about as many rows: enough for a mean. */
constexpr long SlopeRows = 4096;
/**
 * As many voxels past the border everything is background or replicated (until it fades): far
 * places are taken to there, which also keeps the indices small.
 */
constexpr float Beyond = 3.f;
}

Field::Field(const LevelImage& image, const FieldOptions& options, Executor& executor)
  : Level(image)
  , Around(image)
  , Iso(static_cast<float>(options.IsoValue - image.Base))
  , Sign(options.ObjectIsBright ? 1.f : -1.f)
  , Replicate(options.BorderValue == Border::Replicate)
{
  if (!image.Values || image.Size[0] < 1 || image.Size[1] < 1 || image.Size[2] < 1)
  {
    Refuse("The image of a level has no voxels.");
  }
  for (int k = 0; k < 3; ++k)
  {
    this->Inverse[k] = static_cast<float>(1. / image.Step[k]);
  }
  this->MeasureRange(executor);
  this->MeasureSlope();
}

void Field::MeasureRange(Executor& executor)
{
  const std::size_t count =
    static_cast<std::size_t>(this->Level.Size[0]) * this->Level.Size[1] * this->Level.Size[2];
  const std::size_t blocks = (count + RangeBlock - 1) / RangeBlock;
  std::vector<float> lows(blocks);
  std::vector<float> highs(blocks);
  executor.For(blocks, RangeGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t b = begin; b < end; ++b)
      {
        float low = std::numeric_limits<float>::max();
        float high = std::numeric_limits<float>::lowest();
        const std::size_t last = std::min(count, (b + 1) * RangeBlock);
        for (std::size_t i = b * RangeBlock; i < last; ++i)
        {
          const float x = this->Level.Values[i];
          low = x < low ? x : low;
          high = x > high ? x : high;
        }
        lows[b] = low;
        highs[b] = high;
      }
    });
  const float low = *std::min_element(lows.begin(), lows.end());
  const float high = *std::max_element(highs.begin(), highs.end());
  this->HighestValue = std::max(this->Sign * (low - this->Iso), this->Sign * (high - this->Iso));
  this->LowestValue = std::min(this->Sign * (low - this->Iso), this->Sign * (high - this->Iso));
  const float away = std::min(this->LowestValue, -this->HighestValue);
  this->Outside = this->Iso + this->Sign * away;
}

void Field::MeasureSlope()
{
  const auto& size = this->Level.Size;
  const long rows = static_cast<long>(size[1]) * size[2];
  // Odd: so the rows differ from slice to slice where a slice has an even number of them.
  const long stride = std::max(1L, rows / SlopeRows) | 1L;
  double sum = 0.;
  long crossings = 0;
  for (long row = 0; row < rows; row += stride)
  {
    const int j = static_cast<int>(row % size[1]);
    const int k = static_cast<int>(row / size[1]);
    const float* values = this->Level.Values + this->Offset(0, j, k);
    const float* below = j + 1 < size[1] ? values + size[0] : values;
    const float* behind =
      k + 1 < size[2] ? values + static_cast<std::ptrdiff_t>(size[0]) * size[1] : values;
    for (int i = 0; i + 1 < size[0]; ++i)
    {
      const bool here = values[i] > this->Iso;
      if (here != (values[i + 1] > this->Iso))
      {
        sum += std::abs(values[i + 1] - values[i]) * this->Inverse[0];
        ++crossings;
      }
      if (here != (below[i] > this->Iso))
      {
        sum += std::abs(below[i] - values[i]) * this->Inverse[1];
        ++crossings;
      }
      if (here != (behind[i] > this->Iso))
      {
        sum += std::abs(behind[i] - values[i]) * this->Inverse[2];
        ++crossings;
      }
    }
  }
  const double range = static_cast<double>(this->HighestValue) - this->LowestValue;
  this->Slope = static_cast<float>(
    crossings > 0 ? sum / static_cast<double>(crossings) : range * this->Inverse[0]);
  if (!(this->Slope > 0))
  {
    this->Slope = 1;
  }
}

Field::Cell Field::Locate(const Vector& position) const
{
  const auto place = [this](float x, int axis)
  {
    const float scaled = x * this->Inverse[axis];
    const auto size = static_cast<float>(this->Level.Size[axis]);
    return std::min(std::max(scaled, -Beyond), size + (Beyond - 1.f));
  };
  const float x = place(position.X, 0);
  const float y = place(position.Y, 1);
  const float z = place(position.Z, 2);
  constexpr int positive = static_cast<int>(Beyond) + 1; // Makes a floor of the cut-off.
  const int i = static_cast<int>(x + positive) - positive;
  const int j = static_cast<int>(y + positive) - positive;
  const int k = static_cast<int>(z + positive) - positive;
  return { i, j, k, x - static_cast<float>(i), y - static_cast<float>(j),
    z - static_cast<float>(k) };
}

float Field::Fetch(int i, int j, int k) const
{
  const auto& size = this->Level.Size;
  if (i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2])
  {
    return this->Level.Values[this->Offset(i, j, k)];
  }
  if (!this->Replicate)
  {
    return this->Outside;
  }
  i = std::min(std::max(i, 0), size[0] - 1);
  j = std::min(std::max(j, 0), size[1] - 1);
  k = std::min(std::max(k, 0), size[2] - 1);
  return this->Level.Values[this->Offset(i, j, k)];
}

Field::Sample Field::Faded(const Vector& position, const Sample& sample) const
{
  if (!this->Replicate)
  {
    return sample;
  }
  const ImageMargin::Depth depth = this->Around.DepthAt(position);
  if (!(depth.Share > 0))
  {
    return sample;
  }
  const float fall = this->Sign * (this->Outside - this->Iso) - sample.Value;
  return { sample.Value + depth.Share * fall,
    sample.Gradient * (1 - depth.Share) + depth.Slope * fall };
}

float Field::ValueAt(const Vector& position) const
{
  const Cell c = this->Locate(position);
  const auto& size = this->Level.Size;
  float row[2][2];
  if (c.I >= 0 && c.J >= 0 && c.K >= 0 && c.I + 1 < size[0] && c.J + 1 < size[1] &&
    c.K + 1 < size[2])
  {
    const float* at = this->Level.Values + this->Offset(c.I, c.J, c.K);
    const std::ptrdiff_t dy = size[0];
    const std::ptrdiff_t dz = static_cast<std::ptrdiff_t>(size[0]) * size[1];
    for (int k = 0; k < 2; ++k)
    {
      for (int j = 0; j < 2; ++j)
      {
        const float* p = at + j * dy + k * dz;
        row[k][j] = p[0] + c.X * (p[1] - p[0]);
      }
    }
  }
  else
  {
    for (int k = 0; k < 2; ++k)
    {
      for (int j = 0; j < 2; ++j)
      {
        const float a = this->Fetch(c.I, c.J + j, c.K + k);
        row[k][j] = a + c.X * (this->Fetch(c.I + 1, c.J + j, c.K + k) - a);
      }
    }
  }
  const float low = row[0][0] + c.Y * (row[0][1] - row[0][0]);
  const float high = row[1][0] + c.Y * (row[1][1] - row[1][0]);
  const float value = this->Sign * (low + c.Z * (high - low) - this->Iso);
  return this->Replicate ? this->Faded(position, { value, Vector() }).Value : value;
}

Field::Sample Field::At(const Vector& position) const
{
  const Cell c = this->Locate(position);
  const auto& size = this->Level.Size;
  // Twelve rows of the 4 x 4 x 4 voxels around: lerp[k][j] at the place along x; slope[k][j] is
  // the interpolated central difference along x of the four inner rows.
  float lerp[4][4];
  float slope[2][2];
  const bool inner = c.I >= 1 && c.J >= 1 && c.K >= 1 && c.I + 2 < size[0] && c.J + 2 < size[1] &&
    c.K + 2 < size[2];
  const std::ptrdiff_t dy = size[0];
  const std::ptrdiff_t dz = static_cast<std::ptrdiff_t>(size[0]) * size[1];
  const float* at = inner ? this->Level.Values + this->Offset(c.I, c.J, c.K) : nullptr;
  for (int k = 0; k < 4; ++k)
  {
    for (int j = 0; j < 4; ++j)
    {
      const bool innerRow = (k == 1 || k == 2) && (j == 1 || j == 2);
      if ((k == 0 || k == 3) && (j == 0 || j == 3))
      {
        continue;
      }
      float v[4];
      if (inner)
      {
        const float* p = at + (j - 1) * dy + (k - 1) * dz;
        v[1] = p[0];
        v[2] = p[1];
        if (innerRow)
        {
          v[0] = p[-1];
          v[3] = p[2];
        }
      }
      else
      {
        v[1] = this->Fetch(c.I, c.J + j - 1, c.K + k - 1);
        v[2] = this->Fetch(c.I + 1, c.J + j - 1, c.K + k - 1);
        if (innerRow)
        {
          v[0] = this->Fetch(c.I - 1, c.J + j - 1, c.K + k - 1);
          v[3] = this->Fetch(c.I + 2, c.J + j - 1, c.K + k - 1);
        }
      }
      lerp[k][j] = v[1] + c.X * (v[2] - v[1]);
      if (innerRow)
      {
        slope[k - 1][j - 1] = (1 - c.X) * (v[2] - v[0]) + c.X * (v[3] - v[1]);
      }
    }
  }
  const float y = c.Y;
  const float z = c.Z;
  const auto alongY = [&](int k) { return lerp[k][1] + y * (lerp[k][2] - lerp[k][1]); };
  const auto slopeY = [&](int k)
  { return (1 - y) * (lerp[k][2] - lerp[k][0]) + y * (lerp[k][3] - lerp[k][1]); };
  const float low = alongY(1);
  const float high = alongY(2);
  const float gx = (1 - z) * ((1 - y) * slope[0][0] + y * slope[0][1]) +
    z * ((1 - y) * slope[1][0] + y * slope[1][1]);
  const float gy = (1 - z) * slopeY(1) + z * slopeY(2);
  const float gz = (1 - z) * (high - alongY(0)) + z * (alongY(3) - low);
  const float half = 0.5f * this->Sign;
  return this->Faded(position,
    { this->Sign * (low + z * (high - low) - this->Iso),
      Vector(half * gx * this->Inverse[0], half * gy * this->Inverse[1],
        half * gz * this->Inverse[2]) });
}

namespace
{
/** Floor of the gradient, in TypicalSlope. */
constexpr float GradientFloor = 0.15f;
/** Least cosine between a normal and the gradient, for a step along the one to follow the other. */
constexpr float LeastAlignment = 0.5f;
}

float Field::SlopeOf(const Sample& sample) const
{
  return std::max(Length(sample.Gradient), GradientFloor * this->Slope);
}

float Field::StepToIso(const Sample& sample, const Vector& normal, float longest) const
{
  // Value grows against the normal: towards the inside.
  const float slope = -Dot(sample.Gradient, normal);
  if (slope <= GradientFloor * this->Slope || slope < LeastAlignment * Length(sample.Gradient))
  {
    return 0.f;
  }
  return std::min(std::max(sample.Value / slope, -longest), longest);
}
}

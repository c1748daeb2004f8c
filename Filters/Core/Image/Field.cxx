// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/Field.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/VoxelRows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
/** Voxels per span of the search for extremes. */
constexpr std::size_t RangeSpan = 1 << 16;
/** Minimum number of spans per thread. */
constexpr std::size_t RangeGrain = 4;
/** Approximate number of rows on which the typical slope is measured. */
constexpr std::int64_t SlopeRows = 4096;
/** Rows per span. */
constexpr std::size_t SlopeSpan = 128;
/** Positions are clamped to this number of voxels beyond the border, where the field is constant.
 */
constexpr float Beyond = 3.f;
}

Field::Field(const LevelImage& image, const FieldOptions& options, Executor& executor)
  : Level(image), Around(image), Iso(static_cast<float>(options.IsoValue - image.Base)),
    Sign(options.ObjectIsBright ? 1.f : -1.f), Replicate(options.BorderValue == Border::Replicate)
{
  if (!image.Values || image.Size[0] < 1 || image.Size[1] < 1 || image.Size[2] < 1)
  {
    ThrowInvalidArgument("The image of a level has no voxels.");
  }
  for (int k = 0; k < 3; ++k)
  {
    this->Inverse[k] = static_cast<float>(1. / image.Step[k]);
  }
  this->MeasureRange(this->FindExtremes(executor));
  this->MeasureSlope(executor);
}

std::array<float, 2> Field::FindExtremes(Executor& executor) const
{
  const std::size_t count =
    static_cast<std::size_t>(this->Level.Size[0]) * this->Level.Size[1] * this->Level.Size[2];
  const std::size_t spans = (count + RangeSpan - 1) / RangeSpan;
  std::vector<float> lows(spans);
  std::vector<float> highs(spans);
  this->Level.Values.Visit(
    [&](const auto& voxels)
    {
      executor.For(spans, RangeGrain,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t b = begin; b < end; ++b)
          {
            // Stored voxels and values have the same order.
            auto low = voxels.Voxels[b * RangeSpan];
            auto high = low;
            const std::size_t last = std::min(count, (b + 1) * RangeSpan);
            for (std::size_t i = b * RangeSpan; i < last; ++i)
            {
              const auto x = voxels.Voxels[i];
              low = x < low ? x : low;
              high = x > high ? x : high;
            }
            lows[b] = voxels.Value(low);
            highs[b] = voxels.Value(high);
          }
        });
    });
  return { *std::min_element(lows.begin(), lows.end()),
    *std::max_element(highs.begin(), highs.end()) };
}

void Field::MeasureRange(const std::array<float, 2>& extremes)
{
  const float low = extremes[0];
  const float high = extremes[1];
  this->HighestValue = std::max(this->Sign * (low - this->Iso), this->Sign * (high - this->Iso));
  this->LowestValue = std::min(this->Sign * (low - this->Iso), this->Sign * (high - this->Iso));
  const float away = std::min(this->LowestValue, -this->HighestValue);
  this->Outside = this->Iso + this->Sign * away;
}

namespace
{
/** Return the number of rows from one measured row to the next. */
std::int64_t SlopeStride(const std::array<int, 3>& size)
{
  // Odd, so that the measured rows differ between slices with an even number of rows.
  const std::int64_t rows = static_cast<std::int64_t>(size[1]) * size[2];
  return std::max<std::int64_t>(1, rows / SlopeRows) | 1;
}

/** Edges between voxels on different sides of the iso-value. */
struct Crossings
{
  double Slopes = 0.; ///< sum of the slopes
  std::int64_t Count = 0;
};
}

void Field::MeasureSlope(Executor& executor)
{
  const auto& size = this->Level.Size;
  const std::int64_t stride = SlopeStride(size);
  const std::int64_t rows = static_cast<std::int64_t>(size[1]) * size[2];
  const auto sampled = static_cast<std::size_t>((rows + stride - 1) / stride);
  const auto length = static_cast<std::size_t>(size[0]);
  std::vector<Crossings> ofSpans((sampled + SlopeSpan - 1) / SlopeSpan);
  const auto measure = [this](Crossings& found, float here, float beside, int axis)
  {
    if ((here > this->Iso) != (beside > this->Iso))
    {
      found.Slopes += std::abs(beside - here) * this->Inverse[axis];
      ++found.Count;
    }
  };
  ForSpans(executor, sampled, SlopeSpan,
    [&](std::size_t span, std::size_t begin, std::size_t end)
    {
      std::vector<float> buffer(3 * length);
      float* values = buffer.data();
      float* below = values + length;
      float* behind = below + length;
      for (std::size_t i = begin; i < end; ++i)
      {
        const std::int64_t row = static_cast<std::int64_t>(i) * stride;
        const int j = static_cast<int>(row % size[1]);
        const int k = static_cast<int>(row / size[1]);
        this->Level.Values.Copy(this->Offset(0, j, k), size[0], values);
        this->Level.Values.Copy(this->Offset(0, std::min(j + 1, size[1] - 1), k), size[0], below);
        this->Level.Values.Copy(this->Offset(0, j, std::min(k + 1, size[2] - 1)), size[0], behind);
        for (int x = 0; x + 1 < size[0]; ++x)
        {
          measure(ofSpans[span], values[x], values[x + 1], 0);
          measure(ofSpans[span], values[x], below[x], 1);
          measure(ofSpans[span], values[x], behind[x], 2);
        }
      }
    });
  Crossings all;
  for (const Crossings& ofSpan : ofSpans)
  {
    all.Slopes += ofSpan.Slopes;
    all.Count += ofSpan.Count;
  }
  const double range = static_cast<double>(this->HighestValue) - this->LowestValue;
  this->Slope = static_cast<float>(
    all.Count > 0 ? all.Slopes / static_cast<double>(all.Count) : range * this->Inverse[0]);
  if (!(this->Slope > 0))
  {
    this->Slope = 1;
  }
}

Field::Cell Field::Locate(const Vector& position) const
{
  const auto coordinate = [this](float x, int axis)
  {
    const float scaled = x * this->Inverse[axis];
    const auto size = static_cast<float>(this->Level.Size[axis]);
    return std::min(std::max(scaled, -Beyond), size + (Beyond - 1.f));
  };
  const float x = coordinate(position.X, 0);
  const float y = coordinate(position.Y, 1);
  const float z = coordinate(position.Z, 2);
  constexpr int positive = static_cast<int>(Beyond) + 1; // Makes truncation a floor.
  const int i = static_cast<int>(x + positive) - positive;
  const int j = static_cast<int>(y + positive) - positive;
  const int k = static_cast<int>(z + positive) - positive;
  return { i, j, k, x - static_cast<float>(i), y - static_cast<float>(j),
    z - static_cast<float>(k) };
}

template <typename Voxels>
float Field::Fetch(const Voxels& voxels, int i, int j, int k) const
{
  const auto& size = this->Level.Size;
  if (i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2])
  {
    return voxels[this->Offset(i, j, k)];
  }
  if (!this->Replicate)
  {
    return this->Outside;
  }
  i = std::min(std::max(i, 0), size[0] - 1);
  j = std::min(std::max(j, 0), size[1] - 1);
  k = std::min(std::max(k, 0), size[2] - 1);
  return voxels[this->Offset(i, j, k)];
}

void Field::Row(int i, int j, int k, int count, float* values) const
{
  this->Level.Values.Visit(
    [&](const auto& voxels)
    {
      const std::ptrdiff_t first = this->Offset(i, j, k);
      for (int n = 0; n < count; ++n)
      {
        values[n] = this->Sign * (voxels[first + n] - this->Iso);
      }
    });
}

Field::Sample Field::Faded(const Vector& position, const Sample& sample) const
{
  if (!this->Replicate)
  {
    return sample;
  }
  const ImageMargin::Depth depth = this->Around.DepthAt(position);
  if (!(depth.Fraction > 0))
  {
    return sample;
  }
  const float fall = this->Sign * (this->Outside - this->Iso) - sample.Value;
  return { sample.Value + depth.Fraction * fall,
    sample.Gradient * (1 - depth.Fraction) + depth.Slope * fall };
}

float Field::ValueAt(const Vector& position) const
{
  const Cell c = this->Locate(position);
  const auto& size = this->Level.Size;
  float row[2][2];
  this->Level.Values.Visit(
    [&](const auto& voxels)
    {
      const bool inner = c.I >= 0 && c.J >= 0 && c.K >= 0 && c.I + 1 < size[0] &&
        c.J + 1 < size[1] && c.K + 1 < size[2];
      const std::ptrdiff_t dy = size[0];
      const std::ptrdiff_t dz = dy * size[1];
      const std::ptrdiff_t first = inner ? this->Offset(c.I, c.J, c.K) : 0;
      for (int k = 0; k < 2; ++k)
      {
        for (int j = 0; j < 2; ++j)
        {
          const std::ptrdiff_t at = first + j * dy + k * dz;
          const float a = inner ? voxels[at] : this->Fetch(voxels, c.I, c.J + j, c.K + k);
          const float b = inner ? voxels[at + 1] : this->Fetch(voxels, c.I + 1, c.J + j, c.K + k);
          row[k][j] = a + c.X * (b - a);
        }
      }
    });
  const float low = row[0][0] + c.Y * (row[0][1] - row[0][0]);
  const float high = row[1][0] + c.Y * (row[1][1] - row[1][0]);
  const float value = this->Sign * (low + c.Z * (high - low) - this->Iso);
  return this->Replicate ? this->Faded(position, { value, Vector() }).Value : value;
}

template <typename Voxels>
Field::Sample Field::Interpolated(const Cell& cell, const Voxels& voxels, std::ptrdiff_t first,
  std::ptrdiff_t row, std::ptrdiff_t slice) const
{
  const float x = cell.X;
  const float y = cell.Y;
  const float z = cell.Z;
  // Rows at y = -1, 0, 1, 2 in the slices at z = 0 and 1; those at y = 0, 1 at z = -1 and 2.
  const std::ptrdiff_t corner = first - 1 - row;
  const VoxelRows near =
    ReadRows(voxels, { corner, corner + row, corner + 2 * row, corner + 3 * row });
  const std::ptrdiff_t next = corner + slice;
  const VoxelRows far = ReadRows(voxels, { next, next + row, next + 2 * row, next + 3 * row });
  const std::ptrdiff_t before = corner + row - slice;
  const std::ptrdiff_t after = corner + row + 2 * slice;
  const VoxelRows beside = ReadRows(voxels, { before, before + row, after, after + row });

  const Lanes here = x;
  const Lanes there = 1 - x;
  const auto lerp = [&](const VoxelRows& v)
  { return v.Column[1] + here * (v.Column[2] - v.Column[1]); };
  const auto slope = [&](const VoxelRows& v)
  { return there * (v.Column[2] - v.Column[0]) + here * (v.Column[3] - v.Column[1]); };
  float values[3][Lanes::Count];
  float slopes[2][Lanes::Count];
  lerp(near).Store(values[0]);
  lerp(far).Store(values[1]);
  lerp(beside).Store(values[2]);
  slope(near).Store(slopes[0]);
  slope(far).Store(slopes[1]);
  const auto between = [y](const float* v, int j) { return v[j] + y * (v[j + 1] - v[j]); };
  const auto slopeY = [y](const float* v) { return (1 - y) * (v[2] - v[0]) + y * (v[3] - v[1]); };
  const float low = between(values[0], 1);
  const float high = between(values[1], 1);
  const float gx = (1 - z) * ((1 - y) * slopes[0][1] + y * slopes[0][2]) +
    z * ((1 - y) * slopes[1][1] + y * slopes[1][2]);
  const float gy = (1 - z) * slopeY(values[0]) + z * slopeY(values[1]);
  const float gz = (1 - z) * (high - between(values[2], 0)) + z * (between(values[2], 2) - low);
  const float half = 0.5f * this->Sign;
  return { this->Sign * (low + z * (high - low) - this->Iso),
    Vector(
      half * gx * this->Inverse[0], half * gy * this->Inverse[1], half * gz * this->Inverse[2]) };
}

Field::Sample Field::At(const Vector& position) const
{
  const Cell c = this->Locate(position);
  const auto& size = this->Level.Size;
  const Sample sample = this->Level.Values.Visit(
    [&](const auto& voxels)
    {
      if (c.I >= 1 && c.J >= 1 && c.K >= 1 && c.I + 2 < size[0] && c.J + 2 < size[1] &&
        c.K + 2 < size[2])
      {
        const std::ptrdiff_t row = size[0];
        return this->Interpolated(c, voxels, this->Offset(c.I, c.J, c.K), row, row * size[1]);
      }
      float around[4][4][4];
      for (int k = 0; k < 4; ++k)
      {
        for (int j = 0; j < 4; ++j)
        {
          const bool isUnused = (k == 0 || k == 3) && (j == 0 || j == 3);
          for (int i = 0; i < 4 && !isUnused; ++i)
          {
            around[k][j][i] = this->Fetch(voxels, c.I + i - 1, c.J + j - 1, c.K + k - 1);
          }
        }
      }
      return this->Interpolated(c, PlainVoxels{ &around[0][0][0] }, 1 + 4 + 16, 4, 16);
    });
  return this->Faded(position, sample);
}

namespace
{
/** Smallest divisor, in TypicalSlope(). */
constexpr float GradientFloor = 0.15f;
/** Smallest cosine between normal and gradient for a Newton step. */
constexpr float LeastAlignment = 0.5f;
}

float Field::SlopeOf(const Sample& sample) const
{
  return std::max(Length(sample.Gradient), GradientFloor * this->Slope);
}

float Field::StepToIso(const Sample& sample, const Vector& normal, float longest) const
{
  // Value increases inward.
  const float slope = -Dot(sample.Gradient, normal);
  if (slope <= GradientFloor * this->Slope || slope < LeastAlignment * Length(sample.Gradient))
  {
    return 0.f;
  }
  return std::min(std::max(sample.Value / slope, -longest), longest);
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceFields.h"

#include "Core/Labels/VoxelBits.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
/** An object with more than 1 / LargePart of the remaining bricks is processed by all threads. */
constexpr std::int64_t LargePart = 8;

constexpr int PartMargin = 6; ///< bricks around a part, more than the reach of the Gaussian

/** Call visit(i, j, k) for the bricks in a range that contain voxels of a set. */
template <typename Visitor>
void ForBricks(const VoxelBits& voxels, const VoxelBox& within, Visitor&& visit)
{
  constexpr int side = LabelBricks::Side;
  const auto hasVoxels = [&](int i, int j, int k)
  {
    unsigned any = 0;
    for (int row = 0; row < side * side; ++row)
    {
      any |= voxels.FourAt(i * side, j * side + row % side, k * side + row / side);
    }
    return any != 0;
  };
  VoxelBox box = voxels.Box();
  for (int axis = 0; axis < 3; ++axis)
  {
    box.First[axis] /= side;
    box.End[axis] /= side;
  }
  box.CommonWith(within).ForVoxels(
    [&](int i, int j, int k)
    {
      if (hasVoxels(i, j, k))
      {
        visit(i, j, k);
      }
    });
}
}

InterfaceFields::InterfaceFields(const LabelBricks& bricks, const LabelFieldOptions& options,
  const std::array<double, 3>& step, Executor& executor,
  const std::function<bool(double fraction)>& progress, bool isPeriodic)
  : Map(bricks), Lengths(step), IsPeriodic(isPeriodic)
{
  const auto count = static_cast<std::size_t>(bricks.Map().NumberOfObjects) + 1;
  // Largest objects first, for load balancing.
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    { return bricks.ExtentOf(a).Bricks.Count() > bricks.ExtentOf(b).Bricks.Count(); });
  this->Shifts.assign(count, 0.f);
  std::vector<std::vector<Part>> parts(count);
  std::atomic<std::size_t> done{ 0 };
  std::atomic<bool> isRunning{ true };
  const std::int64_t most = 8 * static_cast<std::int64_t>(std::pow(options.PartSize, 3));
  const auto make = [&](int object, Executor& threads)
  {
    if (isRunning && bricks.ExtentOf(object).Voxels > 0)
    {
      const VoxelBox box = bricks.ExtentOf(object).Bricks.Grown(1);
      for (const VoxelBox& within :
        box.Count() > most ? box.Parts(options.PartSize) : std::vector<VoxelBox>{ box })
      {
        if (isRunning)
        {
          parts[static_cast<std::size_t>(object)].push_back(this->PartOf(
            within, MakeLabelField(bricks, object, options, threads, within.Grown(PartMargin))));
        }
      }
    }
    if (!progress(static_cast<double>(++done) / static_cast<double>(count)))
    {
      isRunning = false;
    }
  };
  std::int64_t remaining = 0;
  for (const int object : order)
  {
    remaining += bricks.ExtentOf(object).Bricks.Count();
  }
  // Objects that are a large part of the remaining work use all threads, others one thread each.
  std::size_t first = 0;
  for (; first < count && LargePart * bricks.ExtentOf(order[first]).Bricks.Count() > remaining;
       ++first)
  {
    remaining -= bricks.ExtentOf(order[first]).Bricks.Count();
    make(order[first], executor);
  }
  ForSpans(executor, count - first, 1,
    [&](std::size_t n, std::size_t, std::size_t) { make(order[first + n], OnThisThread()); });
  this->Join(parts);
}

InterfaceFields::Part InterfaceFields::PartOf(const VoxelBox& within, const LabelField& field) const
{
  Part part;
  const VoxelBox inMap = VoxelBox::Of(this->Map.Size()).CommonWith(within);
  ForBricks(field.Rows, inMap,
    [&](int i, int j, int k) { part.Bricks.push_back(this->NumberOfBrick(i, j, k)); });
  part.Values.reserve(part.Bricks.size() * VoxelsOfBrick);
  ForBricks(field.Rows, inMap,
    [&](int i, int j, int k)
    {
      for (int z = k * Side; z < (k + 1) * Side; ++z)
      {
        for (int y = j * Side; y < (j + 1) * Side; ++y)
        {
          const float* row = field.Values.data() + field.Box.NumberOf(i * Side, y, z);
          part.Values.insert(part.Values.end(), row, row + Side);
        }
      }
    });
  return part;
}

void InterfaceFields::Join(std::vector<std::vector<Part>>& parts)
{
  this->First.assign(static_cast<std::size_t>(VoxelBox::Of(this->Map.Size()).Count()) + 1, 0);
  for (const std::vector<Part>& objectParts : parts)
  {
    for (const Part& part : objectParts)
    {
      for (const std::size_t brick : part.Bricks)
      {
        ++this->First[brick + 1];
      }
    }
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  this->BrickEntries.resize(this->First.back());
  std::vector<std::size_t> next(this->First.begin(), this->First.end() - 1);
  for (std::size_t object = 0; object < parts.size(); ++object)
  {
    for (Part& part : parts[object])
    {
      this->Values.push_back(std::move(part.Values));
      float* values = this->Values.back().data();
      for (const std::size_t brick : part.Bricks)
      {
        this->BrickEntries[next[brick]++] = { values, static_cast<LabelMap::Number>(object) };
        values += VoxelsOfBrick;
      }
    }
  }
}

float* InterfaceFields::ValuesIn(std::size_t brick, int object) const
{
  for (std::size_t n = this->First[brick]; n < this->First[brick + 1]; ++n)
  {
    if (this->BrickEntries[n].Object == object)
    {
      return this->BrickEntries[n].Values;
    }
  }
  return nullptr;
}

float InterfaceFields::At(int object, int x, int y, int z) const
{
  const auto [i, j, k] = this->SourceOf({ x, y, z });
  const float* values = this->ValuesIn(this->NumberOfBrick(i / Side, j / Side, k / Side), object);
  if (!values)
  {
    return this->Map.Map().At(i, j, k) == object ? LabelField::Far : -LabelField::Far;
  }
  return values[IndexInBrick(i, j, k)];
}

void InterfaceFields::Push(int object, const std::array<int, 3>& voxel, float by)
{
  const LabelMap& map = this->Map.Map();
  const LabelMap::Number own = map.At(voxel[0], voxel[1], voxel[2]);
  const auto add = [&](const std::array<int, 3>& position, float size)
  {
    const std::array<int, 3> at = this->SourceOf(position);
    const std::size_t brick = this->NumberOfBrick(at[0] / Side, at[1] / Side, at[2] / Side);
    if (float* values = this->ValuesIn(brick, object))
    {
      values[IndexInBrick(at[0], at[1], at[2])] += own == object ? size : -size;
    }
  };
  add(voxel, by);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int step : { -1, 1 })
    {
      std::array<int, 3> at = voxel;
      at[axis] += step;
      if (map.At(at[0], at[1], at[2]) == own && VoxelBox::Of(map.Size()).Contains(at))
      {
        add(at, 0.5f * by);
      }
    }
  }
}

InterfaceFields::Sample InterfaceFields::Interpolate(int object, const Vector& position) const
{
  const std::array<int, 3>& size = this->Map.Map().Size();
  const float coordinates[3] = { position.X, position.Y, position.Z };
  int low[3];
  float fraction[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const float at = coordinates[axis] / static_cast<float>(this->Lengths[axis]);
    low[axis] = std::clamp(static_cast<int>(std::floor(at)), 0, size[axis] - 2);
    fraction[axis] = at - static_cast<float>(low[axis]);
  }
  float corner[2][2][2];
  const VoxelBox& inside = this->Map.Inside();
  const bool isInOneBrick = low[0] % Side < Side - 1 && low[1] % Side < Side - 1 &&
    low[2] % Side < Side - 1 &&
    (!this->IsPeriodic ||
      (inside.Contains({ low[0], low[1], low[2] }) &&
        inside.Contains({ low[0] + 1, low[1] + 1, low[2] + 1 })));
  const float* values = isInOneBrick
    ? this->ValuesIn(this->NumberOfBrick(low[0] / Side, low[1] / Side, low[2] / Side), object)
    : nullptr;
  for (int c = 0; c < 2; ++c)
  {
    for (int b = 0; b < 2; ++b)
    {
      for (int a = 0; a < 2; ++a)
      {
        corner[c][b][a] = values
          ? values[((low[2] + c) % Side * Side + (low[1] + b) % Side) * Side + (low[0] + a) % Side]
          : this->At(object, low[0] + a, low[1] + b, low[2] + c);
      }
    }
  }
  const auto between = [](float first, float last, float t) { return first + t * (last - first); };
  float row[2][2];   // interpolated along x, by z and y
  float along[2][2]; // derivative of row with respect to x
  for (int c = 0; c < 2; ++c)
  {
    for (int b = 0; b < 2; ++b)
    {
      row[c][b] = between(corner[c][b][0], corner[c][b][1], fraction[0]);
      along[c][b] = corner[c][b][1] - corner[c][b][0];
    }
  }
  const float layer[2] = { between(row[0][0], row[0][1], fraction[1]),
    between(row[1][0], row[1][1], fraction[1]) };
  Sample sample;
  sample.Value =
    between(layer[0], layer[1], fraction[2]) + this->Shifts[static_cast<std::size_t>(object)];
  const float x = between(between(along[0][0], along[0][1], fraction[1]),
    between(along[1][0], along[1][1], fraction[1]), fraction[2]);
  const float y = between(row[0][1] - row[0][0], row[1][1] - row[1][0], fraction[2]);
  sample.Gradient =
    Vector(x / static_cast<float>(this->Lengths[0]), y / static_cast<float>(this->Lengths[1]),
      (layer[1] - layer[0]) / static_cast<float>(this->Lengths[2]));
  return sample;
}
}

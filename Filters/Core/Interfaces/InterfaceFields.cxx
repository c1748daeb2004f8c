// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Interfaces/InterfaceFields.h"

#include "Core/Common/Spans.h"
#include "Core/Labels/BoundaryRows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace volumic
{
namespace
{
/** One of so many is a large part. */
constexpr std::int64_t LargePart = 8;

/** Bricks beyond a part in which its field is made, too: further than the Gaussian reaches. */
constexpr int PartMargin = 6;

/**
 * Calls visit(brick, first voxel) for the bricks of the map about the boundary of an object, and
 * within some.
 */
template <typename Visitor>
void ForBricks(const LabelBricks& map, int object, const VoxelBox& within, Visitor&& visit)
{
  constexpr int side = LabelBricks::Side;
  const BoundaryRows rows(map, object, within.Grown(1));
  const std::array<int, 3>& first = rows.Box().First;
  const VoxelBox all = VoxelBox::Of(map.Size());
  for (int k = 0; k < rows.Box().Length(2) / side; ++k)
  {
    for (int j = 0; j < rows.Box().Length(1) / side; ++j)
    {
      for (int i = 0; i < rows.Box().Length(0) / side; ++i)
      {
        const std::array<int, 3> at = { first[0] / side + i, first[1] / side + j,
          first[2] / side + k };
        if (all.Contains(at) && within.Contains(at) && rows.Has(i, j, k))
        {
          visit(static_cast<std::size_t>(all.NumberOf(at[0], at[1], at[2])),
            std::array<int, 3>{ at[0] * side, at[1] * side, at[2] * side });
        }
      }
    }
  }
}

bool HasBricks(const LabelBricks& map, int object, const VoxelBox& within)
{
  bool has = false;
  ForBricks(map, object, within, [&](std::size_t, const std::array<int, 3>&) { has = true; });
  return has;
}
}

InterfaceFields::InterfaceFields(const LabelBricks& bricks, const LabelFieldOptions& options,
  const std::array<double, 3>& step, Executor& executor,
  const std::function<bool(double share)>& goOn, bool isPeriodic)
  : Map(bricks), Lengths(step), IsPeriodic(isPeriodic)
{
  const auto count = static_cast<std::size_t>(bricks.Map().NumberOfObjects) + 1;
  // The largest first, as none should be waited for at the end.
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    { return bricks.ExtentOf(a).Bricks.Count() > bricks.ExtentOf(b).Bricks.Count(); });
  this->Shifts.assign(count, 0.f);
  this->FindBricks(executor);
  std::atomic<std::size_t> done{ 0 };
  std::atomic<bool> goesOn{ true };
  const std::int64_t most = 8 * static_cast<std::int64_t>(std::pow(options.PartSize, 3));
  const auto make = [&](int object, Executor& threads)
  {
    if (goesOn && bricks.ExtentOf(object).Voxels > 0)
    {
      const VoxelBox box = bricks.ExtentOf(object).Bricks.Grown(1);
      const std::vector<VoxelBox> parts =
        box.Count() > most ? box.Parts(options.PartSize) : std::vector<VoxelBox>{ box };
      for (const VoxelBox& part : parts)
      {
        if (goesOn && (parts.size() == 1 || HasBricks(bricks, object, part)))
        {
          this->Take(object, part,
            MakeLabelField(bricks, object, options, threads, part.Grown(PartMargin)));
        }
      }
    }
    if (!goOn(static_cast<double>(++done) / static_cast<double>(count)))
    {
      goesOn = false;
    }
  };
  std::int64_t rest = 0;
  for (const int object : order)
  {
    rest += bricks.ExtentOf(object).Bricks.Count();
  }
  // Those that are a large part of what is left by all threads, the others side by side.
  std::size_t first = 0;
  for (; first < count && LargePart * bricks.ExtentOf(order[first]).Bricks.Count() > rest; ++first)
  {
    rest -= bricks.ExtentOf(order[first]).Bricks.Count();
    make(order[first], executor);
  }
  ForSpans(executor, count - first, 1,
    [&](std::size_t n, std::size_t, std::size_t) { make(order[first + n], OnThisThread()); });
}

void InterfaceFields::FindBricks(Executor& executor)
{
  std::vector<std::vector<std::size_t>> ofObjects(this->Shifts.size());
  ForSpans(executor, ofObjects.size(), 1,
    [&](std::size_t object, std::size_t, std::size_t)
    {
      if (this->Map.ExtentOf(static_cast<int>(object)).Voxels > 0)
      {
        ForBricks(this->Map, static_cast<int>(object), VoxelBox::Of(this->Map.Size()),
          [&](std::size_t brick, const std::array<int, 3>&)
          { ofObjects[object].push_back(brick); });
      }
    });
  this->First.assign(static_cast<std::size_t>(VoxelBox::Of(this->Map.Size()).Count()) + 1, 0);
  for (const std::vector<std::size_t>& found : ofObjects)
  {
    for (const std::size_t brick : found)
    {
      ++this->First[brick + 1];
    }
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  this->Objects.resize(this->First.back());
  std::vector<std::size_t> next(this->First.begin(), this->First.end() - 1);
  for (std::size_t object = 0; object < ofObjects.size(); ++object)
  {
    for (const std::size_t brick : ofObjects[object])
    {
      this->Objects[next[brick]++] = static_cast<LabelMap::Number>(object);
    }
  }
  MakeZeroed(this->Values, this->First.back() * VoxelsOfBrick);
}

void InterfaceFields::Take(int object, const VoxelBox& part, const LabelField& field)
{
  ForBricks(this->Map, object, part,
    [&](std::size_t brick, const std::array<int, 3>& at)
    {
      float* to = this->Values.data() + (this->ValuesIn(brick, object) - this->Values.data());
      for (int z = at[2]; z < at[2] + Side; ++z)
      {
        for (int y = at[1]; y < at[1] + Side; ++y)
        {
          to = std::copy_n(field.Values.data() + field.Box.NumberOf(at[0], y, z), Side, to);
        }
      }
    });
}

const float* InterfaceFields::ValuesIn(std::size_t brick, int object) const
{
  for (std::size_t n = this->First[brick]; n < this->First[brick + 1]; ++n)
  {
    if (this->Objects[n] == object)
    {
      return this->Values.data() + n * VoxelsOfBrick;
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
  return values[PlaceInBrick(i, j, k)];
}

LabelMap::Number InterfaceFields::LargestAt(int i, int j, int k) const
{
  const std::size_t brick = this->NumberOfBrick(i / Side, j / Side, k / Side);
  LabelMap::Number best = this->Map.Map().At(i, j, k);
  float most = this->At(best, i, j, k);
  for (std::size_t n = this->First[brick]; n < this->First[brick + 1]; ++n)
  {
    const float value = this->Values[n * VoxelsOfBrick + PlaceInBrick(i, j, k)];
    if (value > most)
    {
      best = this->Objects[n];
      most = value;
    }
  }
  return best;
}

void InterfaceFields::Push(int object, const std::array<int, 3>& voxel, float by)
{
  const LabelMap& map = this->Map.Map();
  const LabelMap::Number own = map.At(voxel[0], voxel[1], voxel[2]);
  const auto add = [&](const std::array<int, 3>& place, float size)
  {
    const std::array<int, 3> at = this->SourceOf(place);
    const std::size_t brick = this->NumberOfBrick(at[0] / Side, at[1] / Side, at[2] / Side);
    if (const float* values = this->ValuesIn(brick, object))
    {
      this->Values[static_cast<std::size_t>(values - this->Values.data()) +
        PlaceInBrick(at[0], at[1], at[2])] += own == object ? size : -size;
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

InterfaceFields::Sample InterfaceFields::Interpolate(int object, const Vector& place) const
{
  const std::array<int, 3>& size = this->Map.Map().Size();
  const float places[3] = { place.X, place.Y, place.Z };
  int low[3];
  float share[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const float at = places[axis] / static_cast<float>(this->Lengths[axis]);
    low[axis] = std::clamp(static_cast<int>(std::floor(at)), 0, size[axis] - 2);
    share[axis] = at - static_cast<float>(low[axis]);
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
  float row[2][2];   // by z and y
  float along[2][2]; // its derivative by x
  for (int c = 0; c < 2; ++c)
  {
    for (int b = 0; b < 2; ++b)
    {
      row[c][b] = between(corner[c][b][0], corner[c][b][1], share[0]);
      along[c][b] = corner[c][b][1] - corner[c][b][0];
    }
  }
  const float layer[2] = { between(row[0][0], row[0][1], share[1]),
    between(row[1][0], row[1][1], share[1]) };
  Sample sample;
  sample.Value =
    between(layer[0], layer[1], share[2]) + this->Shifts[static_cast<std::size_t>(object)];
  const float x = between(between(along[0][0], along[0][1], share[1]),
    between(along[1][0], along[1][1], share[1]), share[2]);
  const float y = between(row[0][1] - row[0][0], row[1][1] - row[1][0], share[2]);
  sample.Gradient =
    Vector(x / static_cast<float>(this->Lengths[0]), y / static_cast<float>(this->Lengths[1]),
      (layer[1] - layer[0]) / static_cast<float>(this->Lengths[2]));
  return sample;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelBricks.h"

#include "Core/Common/Blocks.h"

#include <algorithm>
#include <mutex>
#include <numeric>

namespace volumic
{
namespace
{
/** Adds a number to a short sorted list, if it is not there. */
void AddTo(std::vector<LabelMap::Number>& objects, LabelMap::Number object)
{
  const auto place = std::lower_bound(objects.begin(), objects.end(), object);
  if (place == objects.end() || *place != object)
  {
    objects.insert(place, object);
  }
}

/** The objects of the voxels [first, end) of a brick, which may reach beyond the map. */
void FindObjectsIn(const LabelMap& map, const std::array<int, 3>& first,
  std::vector<LabelMap::Number>& objects)
{
  constexpr int side = LabelBricks::Side;
  const VoxelBox all = VoxelBox::Of(map.Size);
  const VoxelBox box = { first, { first[0] + side, first[1] + side, first[2] + side } };
  const VoxelBox inside = box.CommonWith(all);
  objects.clear();
  ForRowsOf(inside, all,
    [&](std::int64_t begin, std::int64_t count)
    {
      const LabelMap::Number* row = map.Voxels.data() + begin;
      for (std::int64_t i = 0; i < count; ++i)
      {
        if (i == 0 || row[i] != row[i - 1])
        {
          AddTo(objects, row[i]);
        }
      }
    });
  if (inside.Count() < box.Count())
  {
    AddTo(objects, 0);
  }
}
}

bool LabelBricks::Range::Has(LabelMap::Number object) const
{
  return std::binary_search(this->First, this->Last, object);
}

LabelBricks::LabelBricks(const LabelMap& map, Executor& executor) : Labels(&map)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Count[axis] = (map.Size[axis] + Side - 1) / Side;
  }
  this->FindObjects(executor);
  this->FindExtents(executor);
  this->FindContested(executor);
}

LabelBricks::Range LabelBricks::ObjectsIn(int i, int j, int k) const
{
  const auto brick = static_cast<std::size_t>(VoxelBox::Of(this->Count).NumberOf(i, j, k));
  return { this->Objects.data() + this->First[brick],
    this->Objects.data() + this->First[brick + 1] };
}

void LabelBricks::FindObjects(Executor& executor)
{
  const auto bricksOfLayer = static_cast<std::size_t>(this->Count[0]) * this->Count[1];
  const auto layers = static_cast<std::size_t>(this->Count[2]);
  std::vector<std::vector<LabelMap::Number>> objects(layers);
  std::vector<std::size_t> counts(layers * bricksOfLayer + 1, 0);
  ForBlocks(executor, layers, 1,
    [&](std::size_t k, std::size_t, std::size_t)
    {
      std::vector<LabelMap::Number> found;
      std::size_t brick = k * bricksOfLayer;
      for (int j = 0; j < this->Count[1]; ++j)
      {
        for (int i = 0; i < this->Count[0]; ++i)
        {
          FindObjectsIn(*this->Labels, { i * Side, j * Side, static_cast<int>(k) * Side }, found);
          objects[k].insert(objects[k].end(), found.begin(), found.end());
          counts[++brick] = found.size();
        }
      }
    });
  std::partial_sum(counts.begin(), counts.end(), counts.begin());
  this->First.swap(counts);
  this->Objects = Joined(executor, objects);
}

void LabelBricks::FindExtents(Executor& executor)
{
  const auto numberOfExtents = static_cast<std::size_t>(this->Labels->NumberOfObjects) + 1;
  this->Extents.assign(numberOfExtents, LabelExtent());
  std::mutex mutex;
  const auto rowsOfLayer = static_cast<std::size_t>(this->Labels->Size[1]);
  // Numbers of voxels: the same in whatever order they are added.
  executor.For(static_cast<std::size_t>(this->Count[2]), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<LabelExtent> own(numberOfExtents);
      const auto rowLength = static_cast<std::size_t>(this->Labels->Size[0]);
      const std::size_t last = std::min(end * Side, static_cast<std::size_t>(this->Labels->Size[2]));
      const LabelMap::Number* voxel =
        this->Labels->Voxels.data() + begin * Side * rowsOfLayer * rowLength;
      const LabelMap::Number* const stop =
        this->Labels->Voxels.data() + last * rowsOfLayer * rowLength;
      for (; voxel != stop; ++voxel)
      {
        ++own[*voxel].Voxels;
      }
      for (std::size_t k = begin; k < end; ++k)
      {
        for (int j = 0; j < this->Count[1]; ++j)
        {
          for (int i = 0; i < this->Count[0]; ++i)
          {
            const int at = static_cast<int>(k);
            for (LabelMap::Number object : this->ObjectsIn(i, j, at))
            {
              VoxelBox& box = own[object].Bricks;
              box = box.With({ { i, j, at }, { i + 1, j + 1, at + 1 } });
            }
          }
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t object = 0; object < numberOfExtents; ++object)
      {
        this->Extents[object].Voxels += own[object].Voxels;
        this->Extents[object].Bricks = this->Extents[object].Bricks.With(own[object].Bricks);
      }
    });
}

void LabelBricks::FindContested(Executor& executor)
{
  const VoxelBox all = VoxelBox::Of(this->Count);
  this->Contested.assign(static_cast<std::size_t>(all.Count()), 0);
  const auto layers = static_cast<std::size_t>(this->Count[2]);
  std::vector<unsigned char> any(layers, 0);
  ForBlocks(executor, layers, 1,
    [&](std::size_t layer, std::size_t, std::size_t)
    {
      const int k = static_cast<int>(layer);
      std::vector<LabelMap::Number> met;
      for (int j = 0; j < this->Count[1]; ++j)
      {
        for (int i = 0; i < this->Count[0]; ++i)
        {
          met.clear();
          const VoxelBox about = VoxelBox{ { i - 1, j - 1, k - 1 }, { i + 2, j + 2, k + 2 } };
          const VoxelBox near = about.CommonWith(all);
          if (near.Count() < about.Count())
          {
            met.push_back(0); // Outside the map there is no object.
          }
          for (int c = near.First[2]; c < near.End[2] && met.size() < 3; ++c)
          {
            for (int b = near.First[1]; b < near.End[1]; ++b)
            {
              for (int a = near.First[0]; a < near.End[0]; ++a)
              {
                for (LabelMap::Number object : this->ObjectsIn(a, b, c))
                {
                  AddTo(met, object);
                }
              }
            }
          }
          if (met.size() >= 3)
          {
            this->Contested[static_cast<std::size_t>(all.NumberOf(i, j, k))] = 1;
            any[layer] = 1;
          }
        }
      }
    });
  this->AnyContested = std::find(any.begin(), any.end(), 1) != any.end();
}
}

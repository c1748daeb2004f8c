// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelBricks.h"

#include "Core/Common/Spans.h"

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
  const VoxelBox all = VoxelBox::Of(map.Size());
  const VoxelBox box = { first, { first[0] + side, first[1] + side, first[2] + side } };
  const VoxelBox inside = box.CommonWith(all);
  objects.clear();
  map.ForParts(
    inside, [&](const VoxelBox&, LabelMap::Number object) { AddTo(objects, object); });
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

LabelBricks::LabelBricks(const LabelMap& map, Executor& executor, const VoxelBox& inside)
  : Labels(&map), Counted(inside)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Count[axis] = (map.Size()[axis] + Side - 1) / Side;
  }
  this->FindObjects(executor);
  this->FindExtents(executor);
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
  ForSpans(executor, layers, 1,
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
  // Numbers of voxels: the same in whatever order they are added.
  executor.For(static_cast<std::size_t>(this->Count[2]), 1,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<LabelExtent> own(numberOfExtents);
      VoxelBox part = this->Counted;
      part.First[2] = std::max(part.First[2], static_cast<int>(begin) * Side);
      part.End[2] = std::min(part.End[2], static_cast<int>(end) * Side);
      this->Labels->ForParts(part,
        [&](const VoxelBox& box, LabelMap::Number object) { own[object].Voxels += box.Count(); });
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
}

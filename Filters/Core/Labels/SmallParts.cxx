// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/SmallParts.h"

#include "Core/Image/VoxelBox.h"
#include "Core/Image/VoxelNumbers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <vector>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;

/** Voxels of one object that are joined. */
struct LabelPart
{
  Number Object = 0;
  std::vector<std::int64_t> Voxels;
};

/** All parts of objects from one number to another, in the order of their first voxels. */
class PartFinder
{
public:
  PartFinder(const LabelMap& map, int first, int last)
    : Map(map), First(first), Last(last), Numbers(map.Size), IsFound(map.Voxels.size(), 0)
  {
  }

  std::vector<LabelPart> Find()
  {
    std::vector<LabelPart> parts;
    for (std::size_t v = 0; v < this->Map.Voxels.size(); ++v)
    {
      const Number object = this->Map.Voxels[v];
      if (object >= this->First && object <= this->Last && this->IsFound[v] == 0)
      {
        parts.push_back(this->PartOf(static_cast<std::int64_t>(v)));
      }
    }
    return parts;
  }

private:
  LabelPart PartOf(std::int64_t first)
  {
    LabelPart part;
    part.Object = this->Map.Voxels[static_cast<std::size_t>(first)];
    part.Voxels.push_back(first);
    this->IsFound[static_cast<std::size_t>(first)] = 1;
    const VoxelBox all = VoxelBox::Of(this->Map.Size);
    for (std::size_t n = 0; n < part.Voxels.size(); ++n)
    {
      const std::array<int, 3> at = this->Numbers.PlaceOf(part.Voxels[n]);
      for (int c = 0; c < 27; ++c)
      {
        const std::array<int, 3> near = { at[0] + c % 3 - 1, at[1] + c / 3 % 3 - 1,
          at[2] + c / 9 - 1 };
        if (this->Map.At(near[0], near[1], near[2]) != part.Object)
        {
          continue;
        }
        const std::int64_t voxel = all.NumberOf(near[0], near[1], near[2]);
        if (this->IsFound[static_cast<std::size_t>(voxel)] == 0)
        {
          this->IsFound[static_cast<std::size_t>(voxel)] = 1;
          part.Voxels.push_back(voxel);
        }
      }
    }
    return part;
  }

  const LabelMap& Map;
  int First;
  int Last;
  VoxelNumbers Numbers;
  std::vector<unsigned char> IsFound;
};

/**
 * What it shares most faces with, of objects that have voxels yet, or 0, the outside; of several the
 * one with the smallest number.
 */
Number NeighbourOf(const LabelPart& part, const LabelMap& map, int objects)
{
  const VoxelNumbers numbers(map.Size);
  std::map<Number, std::int64_t> faces;
  for (const std::int64_t voxel : part.Voxels)
  {
    const std::array<int, 3> at = numbers.PlaceOf(voxel);
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const int step : { -1, 1 })
      {
        std::array<int, 3> near = at;
        near[axis] += step;
        const Number other = map.At(near[0], near[1], near[2]);
        if (other != part.Object)
        {
          ++faces[other > objects ? Number(0) : other];
        }
      }
    }
  }
  return std::max_element(faces.begin(), faces.end(),
    [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

void Give(LabelMap& map, const LabelPart& part, Number object)
{
  for (const std::int64_t voxel : part.Voxels)
  {
    map.Voxels[static_cast<std::size_t>(voxel)] = object;
  }
}
}

void GiveAwaySmallParts(
  LabelMap& map, int objects, std::int64_t leastVoxels, bool keepsLargest)
{
  const std::vector<LabelPart> parts = PartFinder(map, 1, objects).Find();
  std::vector<std::size_t> largest(static_cast<std::size_t>(objects) + 1, parts.size());
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    std::size_t& of = largest[parts[n].Object];
    if (of == parts.size() || parts[n].Voxels.size() > parts[of].Voxels.size())
    {
      of = n;
    }
  }
  // All at once, so that none is given to one that goes, too.
  constexpr Number nobodys = std::numeric_limits<Number>::max();
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    const bool isSmall = static_cast<std::int64_t>(parts[n].Voxels.size()) < leastVoxels;
    if (isSmall || (keepsLargest && largest[parts[n].Object] != n))
    {
      Give(map, parts[n], nobodys);
    }
  }
  const std::vector<LabelPart> given = PartFinder(map, nobodys, nobodys).Find();
  std::vector<Number> to;
  for (const LabelPart& part : given)
  {
    to.push_back(NeighbourOf(part, map, objects));
  }
  for (std::size_t n = 0; n < given.size(); ++n)
  {
    Give(map, given[n], to[n]);
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/SmallParts.h"

#include "Core/Common/DisjointSets.h"
#include "Core/Image/VoxelBox.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

namespace volumic
{
namespace
{
using Number = LabelMap::Number;

/** Maximum object number: the sides of a box need numbers as well. */
constexpr int MostObjects = std::numeric_limits<Number>::max() - 8;

struct Run
{
  std::array<int, 3> First;
  int Length;
  Number Object;
};

/** A 26-connected component of the voxels of an object. */
struct LabelPart
{
  Number Object = 0;
  std::int64_t Voxels = 0;
  std::vector<Run> Runs;
};

/** Finds all parts of some objects, in the order of their first voxels. */
class PartFinder
{
public:
  PartFinder(const LabelMap& map, const std::vector<int>& objects)
    : Rows(VoxelBox::Of({ 1, map.Size()[1], map.Size()[2] })), FirstOfRow(1, 0)
  {
    for (int k = 0; k < map.Size()[2]; ++k)
    {
      for (int j = 0; j < map.Size()[1]; ++j)
      {
        map.ForParts({ { 0, j, k }, { map.Size()[0], j + 1, k + 1 } },
          [&](const VoxelBox& part, Number object)
          {
            if (std::binary_search(objects.begin(), objects.end(), object))
            {
              this->Add({ part.First, part.Length(0), object });
            }
          });
        this->FirstOfRow.push_back(this->Runs.size());
      }
    }
  }

  std::vector<LabelPart> Find() const
  {
    DisjointSets sets(this->Runs.size());
    for (std::size_t n = 0; n < this->Runs.size(); ++n)
    {
      const auto [i, j, k] = this->Runs[n].First;
      for (const std::array<int, 2>& step :
        { std::array<int, 2>{ -1, -1 }, { 0, -1 }, { 1, -1 }, { -1, 0 } })
      {
        this->JoinWithRow(n, j + step[0], k + step[1], sets);
      }
    }
    std::vector<LabelPart> parts;
    std::vector<std::size_t> partOf(this->Runs.size(), this->Runs.size());
    for (std::size_t n = 0; n < this->Runs.size(); ++n)
    {
      std::size_t& part = partOf[static_cast<std::size_t>(sets.Find(static_cast<int>(n)))];
      if (part == this->Runs.size())
      {
        part = parts.size();
        parts.push_back({ this->Runs[n].Object, 0, {} });
      }
      parts[part].Voxels += this->Runs[n].Length;
      parts[part].Runs.push_back(this->Runs[n]);
    }
    return parts;
  }

private:
  /** Add a run; merge it with the previous run if it continues this one. */
  void Add(const Run& run)
  {
    const bool isFirst = this->Runs.size() == this->FirstOfRow.back();
    if (!isFirst && this->Runs.back().Object == run.Object &&
      this->Runs.back().First[0] + this->Runs.back().Length == run.First[0])
    {
      this->Runs.back().Length += run.Length;
    }
    else
    {
      this->Runs.push_back(run);
    }
  }

  /** Join a run with the runs of another row that touch it by faces, edges or corners. */
  void JoinWithRow(std::size_t n, int j, int k, DisjointSets& sets) const
  {
    if (!this->Rows.Contains({ 0, j, k }))
    {
      return;
    }
    const Run& run = this->Runs[n];
    const auto row = static_cast<std::size_t>(this->Rows.NumberOf(0, j, k));
    const auto* end = this->Runs.data() + this->FirstOfRow[row + 1];
    const auto* other = std::lower_bound(this->Runs.data() + this->FirstOfRow[row], end,
      run.First[0], [](const Run& one, int i) { return one.First[0] + one.Length < i; });
    for (; other != end && other->First[0] <= run.First[0] + run.Length; ++other)
    {
      if (other->Object == run.Object)
      {
        sets.Join(static_cast<int>(n), static_cast<int>(other - this->Runs.data()));
      }
    }
  }

  VoxelBox Rows; ///< index range of the rows, by y and z
  std::vector<Run> Runs;
  std::vector<std::size_t> FirstOfRow;
};

/** Return the object or background that shares most faces with a part; the first of several. */
Number NeighbourOf(const LabelPart& part, const LabelMap& map)
{
  std::map<Number, std::int64_t> faces;
  for (const Run& run : part.Runs)
  {
    for (int n = 0; n < run.Length; ++n)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        for (const int step : { -1, 1 })
        {
          std::array<int, 3> near = run.First;
          near[0] += n;
          near[axis] += step;
          const Number other = map.At(near[0], near[1], near[2]);
          if (other != part.Object)
          {
            ++faces[other];
          }
        }
      }
    }
  }
  return std::max_element(
    faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
    ->first;
}

void Assign(LabelMap& map, const LabelPart& part, Number object)
{
  for (const Run& run : part.Runs)
  {
    for (int n = 0; n < run.Length; ++n)
    {
      map.Set(run.First[0] + n, run.First[1], run.First[2], object);
    }
  }
}

/** Return the index of the largest part of each object; parts.size() if it has none. */
std::vector<std::size_t> LargestOf(const std::vector<LabelPart>& parts, const LabelMap& map)
{
  std::vector<std::size_t> largest(static_cast<std::size_t>(map.NumberOfObjects) + 1, parts.size());
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    std::size_t& of = largest[parts[n].Object];
    if (of == parts.size() || parts[n].Voxels > parts[of].Voxels)
    {
      of = n;
    }
  }
  return largest;
}
}

void ReassignSmallParts(
  LabelMap& map, const std::vector<int>& objects, std::int64_t leastVoxels, bool keepsLargest)
{
  const std::vector<LabelPart> parts = PartFinder(map, objects).Find();
  const std::vector<std::size_t> largest = LargestOf(parts, map);
  // Mark all small parts first, so that none is assigned to another small part.
  constexpr Number unassigned = std::numeric_limits<Number>::max();
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    const bool isSmall = parts[n].Voxels < leastVoxels;
    if (isSmall || (keepsLargest && largest[parts[n].Object] != n))
    {
      Assign(map, parts[n], unassigned);
    }
  }
  const std::vector<LabelPart> unassignedParts = PartFinder(map, { unassigned }).Find();
  std::vector<Number> neighbours;
  for (const LabelPart& part : unassignedParts)
  {
    neighbours.push_back(NeighbourOf(part, map));
  }
  for (std::size_t n = 0; n < unassignedParts.size(); ++n)
  {
    Assign(map, unassignedParts[n], neighbours[n]);
  }
}

void SeparateParts(LabelMap& map)
{
  std::vector<int> objects(static_cast<std::size_t>(map.NumberOfObjects));
  std::iota(objects.begin(), objects.end(), 1);
  const std::vector<LabelPart> parts = PartFinder(map, objects).Find();
  const std::vector<std::size_t> largest = LargestOf(parts, map);
  std::vector<std::size_t> others;
  for (std::size_t n = 0; n < parts.size(); ++n)
  {
    if (largest[parts[n].Object] != n)
    {
      others.push_back(n);
    }
  }
  std::stable_sort(others.begin(), others.end(),
    [&](std::size_t a, std::size_t b) { return parts[a].Voxels > parts[b].Voxels; });
  const auto room =
    static_cast<std::size_t>(MostObjects - std::min(MostObjects, map.NumberOfObjects));
  others.resize(std::min(others.size(), room));
  map.WholeOf.resize(static_cast<std::size_t>(map.NumberOfObjects) + 1);
  std::iota(map.WholeOf.begin(), map.WholeOf.end(), Number(0));
  for (const std::size_t part : others)
  {
    Assign(map, parts[part], static_cast<Number>(map.WholeOf.size()));
    map.WholeOf.push_back(parts[part].Object);
  }
  map.NumberOfObjects = static_cast<int>(map.WholeOf.size()) - 1;
}
}

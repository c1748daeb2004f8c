// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Labels/LabelMap.h"

namespace volumic
{
LabelMap::LabelMap(const std::array<int, 3>& size) : Voxels(size)
{
  std::transform(size.begin(), size.end(), this->Parts.begin(),
    [](int voxels) { return (voxels + LayerSize - 1) / LayerSize; });
  this->PartEntries.assign(static_cast<std::size_t>(VoxelBox::Of(this->Parts).Count()), 0);
  this->Mixed.resize(static_cast<std::size_t>(this->Parts[2]));
}

void LabelMap::Set(int i, int j, int k, Number object)
{
  if (this->Inside(i, j, k) == object)
  {
    return;
  }
  std::uint32_t& part = this->PartEntries[this->PartAt(i, j, k)];
  LargeVector<Number>& mixed = this->Mixed[static_cast<std::size_t>(k / LayerSize)];
  if ((part & IsMixed) == 0)
  {
    const auto all = static_cast<Number>(part);
    part = static_cast<std::uint32_t>(mixed.size() / VoxelsOfPart) | IsMixed;
    mixed.resize(mixed.size() + VoxelsOfPart, all);
  }
  mixed[(part & ~IsMixed) * VoxelsOfPart + IndexInPart(i, j, k)] = object;
}

VoxelBox LabelMap::Layer(int layer) const
{
  VoxelBox box = VoxelBox::Of(this->Voxels);
  box.First[2] = layer * LayerSize;
  box.End[2] = std::min(box.First[2] + LayerSize, box.End[2]);
  return box;
}

void LabelMap::PutLayer(int layer, const Number* voxels)
{
  const VoxelBox all = this->Layer(layer);
  LargeVector<Number>& mixed = this->Mixed[static_cast<std::size_t>(layer)];
  mixed.clear();
  std::array<Number, VoxelsOfPart> part;
  for (int j = 0; j < this->Parts[1]; ++j)
  {
    for (int i = 0; i < this->Parts[0]; ++i)
    {
      const VoxelBox box = VoxelBox{ { i * LayerSize, j * LayerSize, all.First[2] },
        { (i + 1) * LayerSize, (j + 1) * LayerSize,
          all.End[2] } }.CommonWith(all);
      const Number first = voxels[all.NumberOf(box.First[0], box.First[1], box.First[2])];
      part.fill(first); // including voxels beyond the map
      bool isMixed = false;
      for (int z = box.First[2]; z < box.End[2]; ++z)
      {
        for (int y = box.First[1]; y < box.End[1]; ++y)
        {
          const Number* row = voxels + all.NumberOf(box.First[0], y, z);
          isMixed = isMixed ||
            std::any_of(
              row, row + box.Length(0), [first](Number object) { return object != first; });
          std::copy_n(row, box.Length(0), part.begin() + IndexInPart(0, y, z));
        }
      }
      this->PartEntries[this->PartAt(box.First[0], box.First[1], box.First[2])] =
        isMixed ? static_cast<std::uint32_t>(mixed.size() / VoxelsOfPart) | IsMixed : first;
      if (isMixed)
      {
        mixed.insert(mixed.end(), part.begin(), part.end());
      }
    }
  }
}

LabelMap LabelMap::Part(const VoxelBox& box) const
{
  const auto moved = [](VoxelBox by, const std::array<int, 3>& offset, int sign)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      by.First[axis] += sign * offset[axis];
      by.End[axis] += sign * offset[axis];
    }
    return by;
  };
  LabelMap part(box.Size());
  part.Spacing = this->Spacing;
  part.NumberOfObjects = this->NumberOfObjects;
  std::vector<Number> voxels;
  for (int layer = 0; layer < part.NumberOfLayers(); ++layer)
  {
    const VoxelBox slices = part.Layer(layer);
    voxels.assign(static_cast<std::size_t>(slices.Count()), 0);
    this->ForParts(moved(slices, box.First, 1).CommonWith(VoxelBox::Of(this->Voxels)),
      [&](const VoxelBox& alike, Number object)
      {
        ForRowsOf(moved(alike, box.First, -1), slices,
          [&](std::int64_t first, std::int64_t count)
          { std::fill_n(voxels.begin() + first, count, object); });
      });
    part.PutLayer(layer, voxels.data());
  }
  return part;
}
}

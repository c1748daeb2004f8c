// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelMap_h
#define volumicLabelMap_h

#include "Core/Common/ScratchMemory.h"
#include "Core/Image/VoxelBox.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/**
 * Object number of each voxel. Objects are numbered from 1; 0 is the background and the outside of
 * the map.
 *
 * Voxels are stored in parts of 8 x 8 x 8. A part of one object is stored as a single number, so
 * that memory grows with the boundaries of the objects. Threads may write different layers of parts
 * concurrently.
 */
class LabelMap
{
public:
  using Number = std::uint16_t;
  static constexpr int LayerSize = 8; ///< slices per layer of parts

  LabelMap() = default;
  /** Create a map of background voxels. */
  explicit LabelMap(const std::array<int, 3>& size);

  const std::array<int, 3>& Size() const { return this->Voxels; }
  int NumberOfLayers() const { return this->Parts[2]; }

  /** Voxel spacing along each axis, relative to the smallest one: the unit of all label fields. */
  std::array<double, 3> Spacing = { 1., 1., 1. };
  int NumberOfObjects = 0;
  /** Object to which each object, from 0 on, belongs as a part (SeparateParts); empty: no parts. */
  std::vector<Number> WholeOf;
  Number Whole(int object) const
  {
    return static_cast<std::size_t>(object) < this->WholeOf.size()
      ? this->WholeOf[static_cast<std::size_t>(object)]
      : static_cast<Number>(object);
  }

  Number At(int i, int j, int k) const
  {
    const bool isInside = i >= 0 && j >= 0 && k >= 0 && i < this->Voxels[0] &&
      j < this->Voxels[1] && k < this->Voxels[2];
    return isInside ? this->Inside(i, j, k) : Number(0);
  }
  void Set(int i, int j, int k, Number object);

  /** Set all voxels of a layer. @param voxels slices of the layer, x fastest */
  void PutLayer(int layer, const Number* voxels);
  VoxelBox Layer(int layer) const;
  /** Return the map of a box; voxels beyond this map are background. */
  LabelMap Part(const VoxelBox& box) const;

  /**
   * Call visit(box, object) for boxes of one object each that together cover a box within the map.
   * Boxes of one row are visited in order of x.
   */
  template <typename Visitor>
  void ForParts(const VoxelBox& box, Visitor&& visit) const
  {
    if (box.IsEmpty())
    {
      return;
    }
    for (int k = box.First[2] / LayerSize; k * LayerSize < box.End[2]; ++k)
    {
      for (int j = box.First[1] / LayerSize; j * LayerSize < box.End[1]; ++j)
      {
        for (int i = box.First[0] / LayerSize; i * LayerSize < box.End[0]; ++i)
        {
          this->ForRunsOfPart(i, j, k, box, visit);
        }
      }
    }
  }

private:
  /** Flag in PartEntries: the other bits are an index into Mixed. Otherwise the value is an object.
   */
  static constexpr std::uint32_t IsMixed = 0x80000000u;
  static constexpr std::size_t VoxelsOfPart =
    static_cast<std::size_t>(LayerSize) * LayerSize * LayerSize;

  /** Return the index of a voxel in its part. Unsigned divisions are faster. */
  static std::size_t IndexInPart(unsigned i, unsigned j, unsigned k)
  {
    return (k % LayerSize * LayerSize + j % LayerSize) * LayerSize + i % LayerSize;
  }
  std::size_t PartAt(unsigned i, unsigned j, unsigned k) const
  {
    return i / LayerSize +
      static_cast<std::size_t>(this->Parts[0]) *
      (j / LayerSize + static_cast<std::size_t>(this->Parts[1]) * (k / LayerSize));
  }
  Number Inside(int i, int j, int k) const
  {
    const std::uint32_t part = this->PartEntries[this->PartAt(i, j, k)];
    return (part & IsMixed) == 0
      ? static_cast<Number>(part)
      : this->Mixed[static_cast<unsigned>(k) / LayerSize]
                   [(part & ~IsMixed) * VoxelsOfPart + IndexInPart(i, j, k)];
  }

  template <typename Visitor>
  void ForRunsOfPart(int i, int j, int k, const VoxelBox& box, Visitor&& visit) const
  {
    const VoxelBox part = VoxelBox{
      { i * LayerSize, j * LayerSize, k * LayerSize },
      { (i + 1) * LayerSize, (j + 1) * LayerSize, (k + 1) * LayerSize }
    }.CommonWith(box);
    const std::uint32_t entry =
      this->PartEntries[this->PartAt(i * LayerSize, j * LayerSize, k * LayerSize)];
    if ((entry & IsMixed) == 0)
    {
      visit(part, static_cast<Number>(entry));
      return;
    }
    const Number* voxels =
      this->Mixed[static_cast<std::size_t>(k)].data() + (entry & ~IsMixed) * VoxelsOfPart;
    for (int z = part.First[2]; z < part.End[2]; ++z)
    {
      for (int y = part.First[1]; y < part.End[1]; ++y)
      {
        const Number* row = voxels + IndexInPart(0, y, z);
        for (int x = part.First[0]; x < part.End[0];)
        {
          const Number object = row[x % LayerSize];
          const int first = x++;
          while (x < part.End[0] && row[x % LayerSize] == object)
          {
            ++x;
          }
          visit(VoxelBox{ { first, y, z }, { x, y + 1, z + 1 } }, object);
        }
      }
    }
  }

  std::array<int, 3> Voxels = { 0, 0, 0 };
  std::array<int, 3> Parts = { 0, 0, 0 };
  std::vector<std::uint32_t> PartEntries;
  std::vector<LargeVector<Number>> Mixed; ///< per layer: voxels of the parts with several objects
};
}

#endif

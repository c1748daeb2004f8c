// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicVoxelBox_h
#define volumicVoxelBox_h

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
/** Box of the voxels [First, End) along each axis; empty if an axis is. */
struct VoxelBox
{
  std::array<int, 3> First = { 0, 0, 0 };
  std::array<int, 3> End = { 0, 0, 0 };

  /** Return the box of all voxels of an image. */
  static VoxelBox Of(const std::array<int, 3>& size) { return { { 0, 0, 0 }, size }; }

  int Length(int axis) const { return this->End[axis] - this->First[axis]; }
  std::array<int, 3> Size() const { return { this->Length(0), this->Length(1), this->Length(2) }; }
  bool IsEmpty() const
  {
    return this->Length(0) <= 0 || this->Length(1) <= 0 || this->Length(2) <= 0;
  }
  std::int64_t Count() const
  {
    return this->IsEmpty()
      ? 0
      : static_cast<std::int64_t>(this->Length(0)) * this->Length(1) * this->Length(2);
  }

  bool Contains(const std::array<int, 3>& voxel) const
  {
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      isInside = isInside && voxel[axis] >= this->First[axis] && voxel[axis] < this->End[axis];
    }
    return isInside;
  }

  /** Return an index wrapped into the box, for periodic images. */
  int Wrapped(int at, int axis) const
  {
    const int after = (at - this->First[axis]) % this->Length(axis);
    return this->First[axis] + (after < 0 ? after + this->Length(axis) : after);
  }

  /** Return the linear index of a voxel in the box, x fastest. */
  std::int64_t NumberOf(int i, int j, int k) const
  {
    return i - this->First[0] +
      static_cast<std::int64_t>(this->Length(0)) *
      (j - this->First[1] + static_cast<std::int64_t>(this->Length(1)) * (k - this->First[2]));
  }

  /** Return the intersection. */
  VoxelBox CommonWith(const VoxelBox& other) const
  {
    VoxelBox common;
    for (int axis = 0; axis < 3; ++axis)
    {
      common.First[axis] = std::max(this->First[axis], other.First[axis]);
      common.End[axis] = std::min(this->End[axis], other.End[axis]);
    }
    return common.IsEmpty() ? VoxelBox() : common;
  }

  /** Return the bounding box of both. */
  VoxelBox With(const VoxelBox& other) const
  {
    if (this->IsEmpty() || other.IsEmpty())
    {
      return this->IsEmpty() ? other : *this;
    }
    VoxelBox both;
    for (int axis = 0; axis < 3; ++axis)
    {
      both.First[axis] = std::min(this->First[axis], other.First[axis]);
      both.End[axis] = std::max(this->End[axis], other.End[axis]);
    }
    return both;
  }

  /** Return the difference to another box, as at most six disjoint boxes. */
  std::vector<VoxelBox> Without(const VoxelBox& other) const
  {
    const VoxelBox common = this->CommonWith(other);
    if (common.IsEmpty())
    {
      return this->IsEmpty() ? std::vector<VoxelBox>() : std::vector<VoxelBox>{ *this };
    }
    std::vector<VoxelBox> parts;
    VoxelBox rest = *this;
    for (int axis = 2; axis >= 0; --axis)
    {
      VoxelBox part = rest;
      part.End[axis] = common.First[axis];
      parts.push_back(part);
      part.First[axis] = common.End[axis];
      part.End[axis] = rest.End[axis];
      parts.push_back(part);
      rest.First[axis] = common.First[axis];
      rest.End[axis] = common.End[axis];
    }
    const auto isEmpty = [](const VoxelBox& part) { return part.IsEmpty(); };
    parts.erase(std::remove_if(parts.begin(), parts.end(), isEmpty), parts.end());
    return parts;
  }

  VoxelBox Grown(int by) const
  {
    VoxelBox grown = *this;
    for (int axis = 0; axis < 3; ++axis)
    {
      grown.First[axis] -= by;
      grown.End[axis] += by;
    }
    return grown;
  }

  /** Divide the box into boxes of similar size with at most `most` voxels along each axis. */
  std::vector<VoxelBox> Parts(int most) const
  {
    std::vector<VoxelBox> parts = { *this };
    for (int axis = 0; axis < 3; ++axis)
    {
      const int count = (this->Length(axis) + most - 1) / most;
      std::vector<VoxelBox> thinner;
      for (VoxelBox part : parts)
      {
        for (int n = 0; n < count; ++n)
        {
          part.First[axis] = this->First[axis] + n * this->Length(axis) / count;
          part.End[axis] = this->First[axis] + (n + 1) * this->Length(axis) / count;
          thinner.push_back(part);
        }
      }
      parts.swap(thinner);
    }
    return parts;
  }

  /** Call visit(i, j, k) for each voxel, x fastest. */
  template <typename Visitor>
  void ForVoxels(const Visitor& visit) const
  {
    for (int k = this->First[2]; k < this->End[2]; ++k)
    {
      for (int j = this->First[1]; j < this->End[1]; ++j)
      {
        for (int i = this->First[0]; i < this->End[0]; ++i)
        {
          visit(i, j, k);
        }
      }
    }
  }

  bool operator==(const VoxelBox& other) const
  {
    return (this->IsEmpty() && other.IsEmpty()) ||
      (this->First == other.First && this->End == other.End);
  }
};

/** Call visit(first, count) for each row along x of `part`: linear indices in `box` around it. */
template <typename Visitor>
void ForRowsOf(const VoxelBox& part, const VoxelBox& box, Visitor&& visit)
{
  for (int k = part.First[2]; k < part.End[2]; ++k)
  {
    for (int j = part.First[1]; j < part.End[1] && part.Length(0) > 0; ++j)
    {
      visit(box.NumberOf(part.First[0], j, k), static_cast<std::int64_t>(part.Length(0)));
    }
  }
}
}

#endif

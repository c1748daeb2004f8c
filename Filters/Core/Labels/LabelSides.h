// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSides_h
#define volumicLabelSides_h

#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/LabelField.h"
#include "Core/Labels/VoxelBits.h"

#include <array>

namespace volumic
{
/**
 * Voxels of an object in a box around it, which may extend beyond the map by one brick. The lengths
 * of the box are multiples of 4.
 */
class LabelSides
{
public:
  /** @param within bricks to which the box is limited; it ends at most one brick beyond them */
  LabelSides(const LabelBricks& bricks, int object, const VoxelBox& within);

  const VoxelBox& Box() const { return this->Members.Box(); }
  bool IsObject(int i, int j, int k) const { return this->Members.Has(i, j, k); }
  /** Return the side of a voxel: 1 in the object, -1 elsewhere. */
  float SideOf(int i, int j, int k) const { return this->IsObject(i, j, k) ? 1.f : -1.f; }

  /** @see VoxelBits::FourAt */
  unsigned FourAt(int i, int j, int k) const { return this->Members.FourAt(i, j, k); }

  /** Write 1 in the object and 0 elsewhere for `count` voxels along x, all within the box. */
  void CopyMembership(int i, int j, int k, int count, float* values) const;

  /**
   * Return the voxels with a voxel of the other side within a distance along each axis, diagonals
   * included, in whole groups of four along x.
   */
  VoxelBits NearBoundary(const std::array<int, 3>& reach) const;
  /** Return the distance along each axis, in voxels, up to which fields are computed. */
  static std::array<int, 3> ReachOfFields(double sigma, const std::array<double, 3>& spacing);

  /** Return the voxels whose next voxel along an axis is on the other side. */
  VoxelBits FindChanges(int axis) const
  {
    return this->Members ^ this->Members.Neighbored(axis, true);
  }

  /** Return the voxels whose two neighbors along an axis are both on the other side. */
  VoxelBits FindThin() const;
  /** Return the voxels with a face neighbour in a set and on the other side. */
  VoxelBits FindBeside(const VoxelBits& others) const;

  /**
   * Return the missed voxels: the field has the wrong sign, or 0, there and at all face neighbours
   * of the same side.
   * @param field has the same box
   * @param rows  voxels to test
   */
  VoxelBits FindMissed(const LabelField& field, const VoxelBits& rows, Executor& executor) const;

private:
  VoxelBits Members;
};
}

#endif

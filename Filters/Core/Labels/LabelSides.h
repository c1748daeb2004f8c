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
 * Which voxels belong to an object, in a box about it that may reach beyond the map by a brick.
 * The lengths of the box are multiples of 4.
 */
class LabelSides
{
public:
  /** @param within bricks: the box ends one brick beyond them at most */
  LabelSides(const LabelBricks& bricks, int object, const VoxelBox& within);

  const VoxelBox& Box() const { return this->Members.Box(); }
  bool IsObject(int i, int j, int k) const { return this->Members.Has(i, j, k); }
  /** Return the side of a voxel: 1 in the object, -1 elsewhere. */
  float Of(int i, int j, int k) const { return this->IsObject(i, j, k) ? 1.f : -1.f; }

  /** @see VoxelBits::FourAt */
  unsigned FourAt(int i, int j, int k) const { return this->Members.FourAt(i, j, k); }

  /** Write 1 in the object, 0 elsewhere, for each of `count` voxels along x, all within the box. */
  void CopyMembership(int i, int j, int k, int count, float* values) const;

  /**
   * Return the voxels that have one of the other side at most so many voxels away along each axis,
   * the diagonals included, in whole groups of four along x.
   */
  VoxelBits NearBoundary(const std::array<int, 3>& reach) const;
  /** Return how far fields are computed from the boundary along each axis: for NearBoundary(). */
  static std::array<int, 3> ReachOfFields(double sigma, const std::array<double, 3>& spacing);

  /** Return the voxels whose next one along an axis is on the other side. */
  VoxelBits FindChanges(int axis) const
  {
    return this->Members ^ this->Members.Neighbored(axis, true);
  }

  /** Return the voxels whose two neighbors along an axis are both on the other side. */
  VoxelBits FindThin() const;
  /** Return the voxels that have one of these beside them, on the other side. */
  VoxelBits FindBeside(const VoxelBits& others) const;

  /**
   * Return the voxels at which the field, in the same box, has the wrong sign, or 0, and so it has
   * at all voxels of the same side beside them.
   * @param rows where it may have
   */
  VoxelBits FindMissed(const LabelField& field, const VoxelBits& rows, Executor& executor) const;

private:
  VoxelBits Members;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRegularGrid_h
#define volumicRegularGrid_h

#include "SlabReader.h"

#include <memory>
#include <string>
#include <vector>

namespace tool
{
/** Parallel slices as they were taken, which need not be voxels of a regular grid. */
struct SlicePlaces
{
  std::vector<Vector3> Positions; ///< of the first pixel of each, in the order along their normal
  Vector3 Across = { 1, 0, 0 };   ///< unit vectors along the rows, and from row to row
  Vector3 Down = { 0, 1, 0 };
  std::array<double, 2> Spacing = { 1, 1 }; ///< along these

  /** The unit vector at right angles to both that they follow each other along. */
  Vector3 Normal() const;

  /** Of the slices along the normal, from the first one. */
  std::vector<double> Heights() const;

  /**
   * Why they are no regular grid: uneven distances (by more than 5 percent), or a shift along the
   * slices from one to the next (a tilted gantry). Empty: they are one.
   */
  std::string Unevenness() const;

  /** Where they are one, its place. @param thickness the distance if there is only one slice */
  VolumePlacement Placement(double thickness) const;
};

/**
 * The finest regular grid that holds the slices, as slices: from the first to the last, as far from
 * each other as the nearest two, and as wide as all together. Values between are interpolated
 * linearly, to the type that they have, and labels are those of the nearest voxel; where no slice
 * is, they are `outside`. It is told, and is the grid's Resampling.
 * @param why they are none
 * @throws Failure if it must not be, or if the grid would have many times as many voxels
 */
std::unique_ptr<SlabReader> ResampledSlices(std::shared_ptr<SlabReader> slices,
  const SlicePlaces& places, const std::string& why, double outside, const Opening& opening);

/**
 * The volume if its axes are at right angles, else, as such slices, on the regular grid that holds
 * it; outside of it is the least of its values, or, of labels, 0.
 */
std::shared_ptr<SlabReader> AtRightAngles(
  std::shared_ptr<SlabReader> volume, const Opening& opening);
}

#endif

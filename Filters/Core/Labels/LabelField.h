// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelField_h
#define volumicLabelField_h

#include "Core/Common/Executor.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Image/VoxelBox.h"
#include "Core/Labels/LabelBricks.h"
#include "Core/Labels/VoxelBits.h"

#include <cstdint>
#include <vector>

namespace volumic
{
/** Parameters of MakeLabelField(). Lengths are in the smallest voxel spacing. */
struct LabelFieldOptions
{
  /** Standard deviation of the Gaussian, the same along all axes. 0: no smoothing, field +-1/2. */
  double Sigma = 2.;
  /**
   * Least distance of the isosurface from a voxel centre. With a smaller value triangles cut off
   * voxel centres; with a larger one the voxel staircase returns.
   */
  double Margin = 0.1;
  /**
   * Allowed distance of a misclassified voxel centre from the isosurface. It does not apply to a
   * voxel without a correctly classified face neighbour of the same side, so that no part is lost.
   */
  double Tolerance = 0.;
  /** Margin of thin voxels, whose two neighbours along an axis are both on the other side. */
  double ThinMargin = 0.4;
  /** Margin of the neighbours of thin voxels; with less, a part 1 voxel thick becomes 2 thick. */
  double MarginBesideThin = 0.25;
  /**
   * Maximum absolute field value at the neighbours of thin voxels, as a fraction of the distance to
   * the thin voxel. It applies where the value exceeds this distance: the Gaussian alone leaves a
   * rod or a single voxel a fraction of its width.
   */
  double MostBesideThin = 0.35;
  /**
   * Fraction of the Laplacian that is subtracted from the distance. Triangles with vertices on a
   * curved surface cut off e^2 / 16 times the curvature in the mean, e being the edge length. With
   * a Tolerance, only the tangential part of the Laplacian is used, as the field has a ridge in
   * thin parts. Without, the full Laplacian is used, which compensates for the constraints.
   */
  double ChordCorrection = 0.3;
  /**
   * Edge length in bricks of the parts in which InterfaceFields computes a large field, to bound
   * its memory. Fields of at most eight parts are computed at once.
   */
  int PartSize = 48;
};

/** A field on the voxels of a box, which may extend beyond the map. */
struct LabelField
{
  /** Maximum absolute value, also the absolute value of all voxels further from the boundary. */
  static constexpr float Far = 4.f;

  VoxelBox Box;
  LargeVector<float> Values; ///< positive inside; x fastest
  /** The voxels whose values are computed. */
  VoxelBits Rows;
  /** With a tolerance: voxels to which it does not apply (LabelFieldOptions::Tolerance). */
  VoxelBits IsConstrained;
};

/**
 * Compute the approximate signed distance to the boundary of an object, positive inside. Without a
 * Tolerance, the sign is correct at all voxel centres. The field depends on the voxels of this
 * object only. If two objects meet and no third one is near, one field is the negative of the
 * other.
 *
 * 1. Distance: smooth the membership (1 in the object, 0 elsewhere) with a Gaussian of width sigma.
 *    At a flat boundary the result g is the normal distribution of the distance. Hence the distance
 *    is d = sigma * quantile(g). Thin parts may be missed: d has the wrong sign at a voxel centre
 *    and at all face neighbours of the same side. Near these voxels sigma is reduced until none is
 *    missed. This is done after step 2, or before step 2 with a Tolerance.
 * 2. Volume correction: d is biased at curved boundaries and thin parts. Smooth the missing volume,
 *    membership - clamp(d + 1/2, 0, 1), with the same Gaussian. Add it times sigma * sqrt(2 pi).
 *    With a Tolerance, reduce this factor where two boundaries are near: divide it by the smoothed
 *    indicator of |d| < 1/2.
 * 3. Chord correction (ChordCorrection).
 * 4. Constraints: apply the smallest change that gives all voxel centres the sign of the map and at
 *    least the absolute value Margin. The norm is that of the reproducing kernel, a sum of two
 *    Gaussians. The quadratic programme is solved by coordinate ascent in its multipliers. With a
 *    Tolerance, only larger errors are corrected, and then those of missed voxels.
 *
 * @param within bricks in which the field is computed, plus one brick beyond them. Use parts for
 *               large objects. At distances from the ends of the box beyond the reach of the
 *               Gaussian, the values equal those of the whole object, except for effects of step 4.
 */
LabelField MakeLabelField(const LabelBricks& bricks, int object, const LabelFieldOptions& options,
  Executor& executor, const VoxelBox& within);
}

#endif

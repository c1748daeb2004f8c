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
/** How the field of an object is made. Lengths in smallest distances of voxels. */
struct LabelFieldOptions
{
  /** Standard deviation of the Gaussian, the same along all axes. 0: none, the field is +-1/2. */
  double Sigma = 2.;
  /**
   * How far from a voxel's centre the isopotential stays: with less it passes so near to the
   * centre that triangles cut it off, with more stairs come back.
   */
  double Margin = 0.1;
  /**
   * How far it may be on the other side of the centre, if that of a voxel beside it, of the same
   * side, is where it belongs: so that no part is lost.
   */
  double Tolerance = 0.;
  /** The same for a voxel whose two neighbours along an axis are both on the other side, */
  double ThinMargin = 0.4;
  /** and for these: with less a part that is a voxel thin gets the thickness of two. */
  double MarginBesideThin = 0.25;
  /**
   * What the same are held to, as a share of the way to the thin one, where the field has them
   * further outside than that is: the Gaussian leaves a rod, or a single voxel, a fraction of its
   * width.
   */
  double MostBesideThin = 0.35;
  /**
   * How much of its Laplacian is taken off the distance: triangles whose corners are on a bent
   * surface cut off e^2 / 16 of it in the mean, e being the length of their edges. With a Tolerance
   * only what of it is along the isosurface: across a thin part the field is a ridge, which is no
   * bend. Without, all of it, which makes up for what is held.
   */
  double ChordCorrection = 0.3;
  /**
   * Of InterfaceFields: a field in a box of more than eight parts, each so many bricks wide, is
   * made in such parts, as its memory grows with the box.
   */
  int PartSize = 48;
};

/** A field over the voxels of a box, which may reach beyond the map. */
struct LabelField
{
  /** It is cut off at this size; voxels that are further away have this one. */
  static constexpr float Far = 4.f;

  VoxelBox Box;
  LargeVector<float> Values; ///< positive inside; x fastest
  /** The voxels whose values are computed. */
  VoxelBits Rows;
  /** With a tolerance: the voxels without one, as no voxel beside them is where it belongs. */
  VoxelBits IsConstrained;
};

/**
 * About the distance to the boundary of an object, positive inside, right by its sign at all voxel
 * centres. It is found from the voxels of this object alone, so that of two objects that meet, with
 * no third one near, one's is the other's times -1.
 *
 * 1. The membership, 1 in the object and 0 elsewhere, smoothed by a Gaussian, g. Of a flat boundary
 *    it is the normal distribution of the distance, whose inverse makes a distance d of it: sigma
 *    times the quantile of g. Where d is wrong at a voxel's centre, and at all of its side beside
 *    it, as in what is thin, a narrower Gaussian takes its place, until none is lost: after step 2,
 *    but with a Tolerance before it.
 * 2. Where the boundary is bent, or the object thin, d is off to one side. The Gaussian of
 *    (membership - clamp(d + 1/2, 0, 1)), the volume that is missing near each place, times
 *    sigma sqrt(2 pi), is added to it. With a Tolerance that factor is less where two boundaries
 *    are near, each of which it moves: over the Gaussian of the places where |d| < 1/2.
 * 3. ChordCorrection.
 * 4. The smallest change, in the norm of which a sum of two Gaussians is the kernel, that gives all
 *    voxel centres the sign that they have in the map, and Margin as size: a quadratic programme,
 *    solved by coordinate ascent in its multipliers, voxel after voxel. With a Tolerance only what
 *    is further off than that is changed, and then what would be lost.
 *
 * Tried instead: the sign alone held (single voxels stick out as spikes), the thin plate energy of
 * d under the same constraints (twice the error of the normals), Gaussians of higher order instead
 * of 2 (up to .9 % of the volume is lost).
 *
 * @param within bricks: the field is made in them, and one brick beyond them: of large objects in
 *               parts. The values are those of the whole object further from the ends of the box
 *               than the Gaussian reaches, except for what step 4 carries over.
 */
LabelField MakeLabelField(const LabelBricks& bricks, int object, const LabelFieldOptions& options,
  Executor& executor, const VoxelBox& within);
}

#endif

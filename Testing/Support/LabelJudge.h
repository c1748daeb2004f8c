// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What SurfaceJudge.h does not ask, for surfaces of labels: how near a surface is to the shape that
 * was digitised, how smooth it is, and whether it loses voxels. All functions throw what those of
 * SurfaceJudge.h throw.
 */

#ifndef volumicLabelJudge_h
#define volumicLabelJudge_h

#include "LabelShapes.h"
#include "TriangleSurface.h"

#include <cstddef>

namespace volumic::support
{

/** World units. The angle is that of normals of triangles, means are by area where they can be. */
struct TruthVerdict
{
  double MeanAtVertices = 0.0;
  double MeanAtCentroids = 0.0;
  double Largest = 0.0;     ///< of vertices and centroids
  double MeanAngle = 0.0;   ///< degrees, between the normals of triangle and shape, by area
  double VolumeError = 0.0; ///< as a share of the shape's, positive where the surface has more
};

/** Throws std::invalid_argument for a shape without Distance. */
TruthVerdict JudgeTruth(const TriangleSurface& surface, const LabelShape& shape);

/** Angles between the normals of triangles at an edge, degrees; edges with two triangles only. */
struct DihedralVerdict
{
  double Median = 0.0;
  double Quantile95 = 0.0;
  double Largest = 0.0;
};

DihedralVerdict JudgeDihedrals(const TriangleSurface& surface);

/** Voxels whose centres are on the wrong side. */
struct MisclassifiedVoxelVerdict
{
  std::size_t Outside = 0; ///< of the label, but not enclosed
  std::size_t Inside = 0;  ///< of others, but enclosed
  std::size_t Label = 0;   ///< all that the label has

  std::size_t Wrong() const { return this->Outside + this->Inside; }
};

/** The surface is in the world of the map. */
MisclassifiedVoxelVerdict JudgeVoxels(
  const TriangleSurface& surface, const LabelMap& map, int label);

} // namespace volumic::support

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelJudge_h
#define volumicLabelJudge_h

#include "LabelShapes.h"
#include "TriangleSurface.h"

#include <cstddef>

/** Accuracy, smoothness and misclassified voxels of label surfaces. */
namespace volumic::support
{
/** Distance to the digitised shape, in world units. Means of triangles are weighted by area. */
struct TruthVerdict
{
  double MeanAtVertices = 0.0;
  double MeanAtCentroids = 0.0;
  double MeanAngle = 0.0;   ///< between the normals of triangle and shape, degrees
  double VolumeError = 0.0; ///< relative; positive if the surface encloses more than the shape
};

TruthVerdict JudgeTruth(const TriangleSurface& surface, const LabelShape& shape);

/** Return the 95 % quantile of the angles between the two triangles at an edge, degrees. */
double DihedralQuantile(const TriangleSurface& surface);

/** Numbers of voxels whose centres are misclassified. */
struct MisclassifiedVoxelVerdict
{
  std::size_t Outside = 0; ///< voxels of the label that are not enclosed
  std::size_t Inside = 0;  ///< enclosed voxels of other labels
  std::size_t Label = 0;   ///< all voxels of the label

  std::size_t Misclassified() const { return this->Outside + this->Inside; }
};

/** Count misclassified voxels. The surface is in world coordinates. */
MisclassifiedVoxelVerdict JudgeVoxels(
  const TriangleSurface& surface, const LabelMap& map, int label);

} // namespace volumic::support

#endif

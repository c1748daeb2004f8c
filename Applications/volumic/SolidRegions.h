// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSolidRegions_h
#define volumicSolidRegions_h

#include "SurfaceFacts.h"
#include "VolumeImage.h"

#include <array>
#include <cstddef>
#include <vector>

class vtkPolyData;

namespace tool
{
/** A connected part of space, bounded by triangles. */
struct SolidRegion
{
  int Label = -1; ///< which of SolidRegions::Labels; -1: of none, it is empty
  Vector3 Inside = { 0.0, 0.0, 0.0 }; ///< a point in it, off its boundary; none of the outermost
};

/**
 * What meshers of solids have to know: the connected regions into which triangles part space.
 * Region 0 is the outermost one, all others are bounded; those of labels come first, in their order.
 */
struct SolidRegions
{
  struct Triangle
  {
    std::array<vtkIdType, 3> Corners;
    int Behind;  ///< the region that its normal points away from: one of a label
    int InFront; ///< the other one
  };
  std::vector<SurfaceLabel> Labels;
  std::vector<SolidRegion> Regions;
  std::vector<Triangle> Triangles;

  /** Whether a label fills it. */
  bool IsSolid(std::size_t region) const { return this->Regions[region].Label >= 0; }
};

/**
 * The regions of the output `Interfaces` of vtkLabelsToSurfaces, or, without `BoundaryLabels`, of a
 * closed surface, of one label then, with the label's name or `object`.
 * @throws Failure, without the name of a file, if the triangles do not part space.
 */
SolidRegions FindRegions(vtkPolyData* surface);
}

#endif

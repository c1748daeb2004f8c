// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** What vtkDeformableSurface is measured against. */

#ifndef SurfacePeers_h
#define SurfacePeers_h

#include "TriangleSurface.h"

class vtkImageData;

namespace volumic
{
namespace bench
{

/** What a user would do today for even triangles: vtkFlyingEdges3D, its largest component, smoothed
   by vtkWindowedSincPolyDataFilter, then CGAL's isotropic_remeshing in 3 iterations to edges of
   about `edgeLength` voxels. Index coordinates of the image, which should have a border of air. */
support::TriangleSurface RemeshedMarchingSurface(
  vtkImageData* image, double isoValue, double edgeLength);

} // namespace bench
} // namespace volumic

#endif

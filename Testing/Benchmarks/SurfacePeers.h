// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What vtkDeformableSurface is measured against. All take an image at index coordinates (extent
 * from 0, origin 0, spacing 1) with a border of air, and give surfaces in the same; lengths are in
 * voxels. The image has to live as long as the job.
 */

#ifndef volumicSurfacePeers_h
#define volumicSurfacePeers_h

#include "TriangleSurface.h"

#include <functional>

class vtkImageData;

namespace volumic::bench
{

struct SurfaceJob
{
  std::function<void()> Work;                       ///< what is measured
  std::function<support::TriangleSurface()> Result; ///< then, what it made, as the judge wants it
  std::function<double()> Iterations; ///< how many it took; empty where there are none
};

/** vtkFlyingEdges3D. */
SurfaceJob FlyingEdgesJob(vtkImageData* image, double isoValue);

/** Its largest component, smoothed by vtkWindowedSincPolyDataFilter with normalized coordinates and
    else its defaults. */
SurfaceJob SmoothedJob(vtkImageData* image, double isoValue);

/** The same, then vtkQuadricDecimation to about `vertices`. */
SurfaceJob DecimatedJob(vtkImageData* image, double isoValue, long long vertices);

/** What a user would do today for well-shaped triangles: the smoothed surface, then CGAL's
    isotropic_remeshing in 3 iterations to edges of about `edgeLength`. */
SurfaceJob RemeshedJob(vtkImageData* image, double isoValue, double edgeLength);

/** CGAL's make_surface_mesh on the trilinear field: angles of at least 30 degrees, surface Delaunay
    balls of at most `radius`, their centres at most half of it from those of the triangles. It
    starts from a voxel in the largest part of the object, near that part's barycentre. */
SurfaceJob MesherJob(vtkImageData* image, double isoValue, bool objectIsBright, double radius);

/** The radius that makes its mean edge about `edgeLength`. */
double MesherRadius(double edgeLength);

/** itk::ThresholdSegmentationLevelSetImageFilter from the border inward, to an RMS change of 0.02
    or 1200 iterations, then vtkFlyingEdges3D on its level set. One thread. */
SurfaceJob LevelSetJob(vtkImageData* image, double isoValue, bool objectIsBright);

} // namespace volumic::bench

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What vtkLabelsToSurfaces is measured against: surfaces about one label of an image, in its world.
 * The label must not touch the border of the image. The image has to live as long as the job.
 */

#ifndef volumicLabelPeers_h
#define volumicLabelPeers_h

#include "SurfacePeers.h"

#include <vtkVersionMacros.h>

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
#define VOLUMIC_BENCHMARK_SURFACE_NETS
#endif

namespace volumic::bench
{

/** vtkDiscreteFlyingEdges3D and vtkWindowedSincPolyDataFilter with normalized coordinates; its
    defaults are 20 and .1, VTK's examples of labels have 15 and .001. */
SurfaceJob WindowedLabelJob(vtkImageData* image, int label, int iterations, double passBand);

/** The same with the defaults, then CGAL's isotropic_remeshing in 3 iterations to edges of about
    `edgeLength`; what is not manifold is cut apart before. */
SurfaceJob RemeshedLabelJob(vtkImageData* image, int label, double edgeLength);

#if defined(VOLUMIC_BENCHMARK_SURFACE_NETS)
/** vtkSurfaceNets3D with its smoothing, triangles. */
SurfaceJob NetsLabelJob(vtkImageData* image, int label);
#endif

/** itk::AntiAliasBinaryImageFilter with its defaults, then vtkFlyingEdges3D. */
SurfaceJob AntiAliasedLabelJob(vtkImageData* image, int label);

} // namespace volumic::bench

#endif

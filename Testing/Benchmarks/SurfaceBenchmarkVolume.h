// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The volume that BenchmarkSurface measures on, as each of those who are measured wants it. */

#ifndef volumicSurfaceBenchmarkVolume_h
#define volumicSurfaceBenchmarkVolume_h

#include "RunFigures.h"
#include "SurfaceBenchmarkOptions.h"
#include "TriangleSurface.h"

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <array>

namespace volumic::bench
{

struct BenchmarkedVolume
{
  vtkSmartPointer<vtkImageData> Image; ///< its own scalar type, point scalars, one component
  double IsoValue = 0.0;
  bool ObjectIsBright = true;
};

/** Reads or makes the volume that the options name, resampled if they say so. Throws
    std::runtime_error with what is wrong with the file or the scene. */
BenchmarkedVolume LoadVolume(const SurfaceBenchmarkOptions& options);

/** Writes it to options.WriteVolume, uncompressed, so that to read it takes no more memory than it
    has. IsoValue, and BytesOfVoxel. Throws the same. */
RunFigures WriteVolume(const SurfaceBenchmarkOptions& options);

/** Scaled by one factor along all axes (linear interpolation; voxels at the border stay there) so
    that the number of voxels is about size^3. */
vtkSmartPointer<vtkImageData> Resampled(vtkImageData* image, int size);

/** The image with a voxel of air around it, the value farthest from the object. Keeps the scalar
    type and the place in the world. */
vtkSmartPointer<vtkImageData> InAir(vtkImageData* image, bool objectIsBright);

/** Distances of the voxels along each axis: all 1 in the metric of voxels; in that of the world
    their ratios to the smallest, so that a length of 1 is the same in both along that axis. */
std::array<double, 3> StepsOf(vtkImageData* image, LengthMetric metric);

/** The same voxels, shared: extent from 0, origin 0, and this spacing. */
vtkSmartPointer<vtkImageData> InSteps(vtkImageData* image, const std::array<double, 3>& steps);

/** Index coordinates, or those of InSteps, times `factors`. */
support::TriangleSurface Stretched(
  support::TriangleSurface surface, const std::array<double, 3>& factors);

} // namespace volumic::bench

#endif

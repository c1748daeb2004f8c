// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/**
 * What vtkImagePyramid is measured against. Each function does the whole job once, from voxels to
 * images, and throws its results away.
 */

#ifndef volumicPyramidPeers_h
#define volumicPyramidPeers_h

#include <array>
#include <cstdint>
#include <vector>

class vtkImageData;

namespace volumic::bench
{

/** Sizes of the levels from 1 on. The first is made from the volume, each other from the one
 * before. */
using LevelSizes = std::vector<std::array<int, 3>>;

/** vtkImageGaussianSmooth with 5 taps (standard deviation 1 voxel), then vtkImageResize. */
void RunVtkPyramid(vtkImageData* volume, const LevelSizes& sizes, int threads);

/** Copies the voxels of the volume to memory that is there already and has their number. */
void RunCopy(vtkImageData* volume, std::vector<std::int16_t>& copy, int threads);

/** itk::DiscreteGaussianImageFilter (variance 1, at most 5 taps) to float, then
   itk::ResampleImageFilter with linear interpolation. Only where ITK was found. */
void RunItkPyramid(vtkImageData* volume, const LevelSizes& sizes, int threads);

} // namespace volumic::bench

#endif

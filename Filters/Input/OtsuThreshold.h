// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicOtsuThreshold_h
#define volumicOtsuThreshold_h

#include <vtkType.h>

#include <array>
#include <vector>

class vtkImageData;
class vtkInformation;

namespace volumic
{
/** The values of an image's voxels, and what parts them best. */
struct VoxelHistogram
{
  std::array<double, 2> Range = { 0.0, 0.0 }; ///< of the voxels, but for the padding of CT
  std::vector<vtkIdType> Counts;              ///< voxels of each bin of it
  double Threshold = 0.0;
};

/**
 * What vtkOtsuThreshold finds.
 * @param selection of the voxels, as GetInputArrayInformation()
 * @param numberOfThreads as HostThreads
 * @throws std::invalid_argument where there is no such value.
 */
VoxelHistogram FindOtsuThreshold(
  vtkImageData* image, vtkInformation* selection, int component, int numberOfThreads);
}

#endif

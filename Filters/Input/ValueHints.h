// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicValueHints_h
#define volumicValueHints_h

#include <vtkType.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkInformation;

namespace volumic
{
struct VoxelHistogram
{
  std::array<double, 2> Range = { 0.0, 0.0 }; ///< of the voxels, without the padding of a CT
  std::vector<vtkIdType> Counts;              ///< number of voxels of each bin
  double Threshold = 0.0;
  /**
   * Otsu's threshold of the voxels above Threshold, rounded to two digits. It is NaN unless the
   * object is large and has a small bright part, such as bone in CT or vessels in MR.
   */
  double BrightThreshold = std::numeric_limits<double>::quiet_NaN();
};

/**
 * Compute the histogram and the thresholds of vtkOtsuThreshold.
 * @param selection selection of the voxels, as from GetInputArrayInformation()
 * @throws InvalidArgument if no value separates the voxels
 */
VoxelHistogram FindOtsuThreshold(vtkImageData* image, vtkInformation* selection, int component);

/**
 * Return a warning that names vtkLabelsToSurfaces if voxels look like a label map, or an empty
 * string. They do if they are integers with few different values, and if almost all neighbors along
 * x are equal. Background, the most frequent value, is ignored. Only some rows are tested.
 * @param size voxels along each axis
 */
std::string HintAtLabels(vtkDataArray* voxels, const int size[3]);

/**
 * Return a warning if a label map looks like a scan, or an empty string. It does if it has more
 * than 256 labels, and if more than a third of the neighbors along x differ. Only some rows are
 * tested.
 */
std::string HintAtScan(vtkDataArray* voxels, const int size[3], std::size_t labels);
}

#endif

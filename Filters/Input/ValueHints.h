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
/** The values of an image's voxels, and what parts them best. */
struct VoxelHistogram
{
  std::array<double, 2> Range = { 0.0, 0.0 }; ///< of the voxels, but for the padding of CT
  std::vector<vtkIdType> Counts;              ///< voxels of each bin of it
  double Threshold = 0.0;
  /**
   * Otsu's threshold of the voxels above the first threshold, rounded to two digits, if the object is
   * large and has a small bright part, such as bone in CT or vessels in MR; else NaN.
   */
  double BrightThreshold = std::numeric_limits<double>::quiet_NaN();
};

/**
 * What vtkOtsuThreshold finds.
 * @param selection of the voxels, as GetInputArrayInformation()
 * @throws std::invalid_argument where there is no such value.
 */
VoxelHistogram FindOtsuThreshold(vtkImageData* image, vtkInformation* selection, int component);

/**
 * What someone should know who searches an isopotential in a label map: that there is a filter for
 * that. Empty: the voxels don't look like one. They do where they are integers, of which not many
 * are different, and almost all neighbours along x that are no background (the most frequent value)
 * are equal. Some rows are looked at.
 *
 * @param size voxels along each axis
 */
std::string HintAtLabels(vtkDataArray* voxels, const int size[3]);

/**
 * Return a warning for a label map that looks like a scan, else nothing: it has more than 256
 * labels, and more than a third of the neighbours along x differ. Some rows are tested.
 */
std::string HintAtScan(vtkDataArray* voxels, const int size[3], std::size_t labels);
}

#endif

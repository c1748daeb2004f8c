// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause

/** The label maps of BenchmarkLabels. */

#ifndef volumicLabelMaps_h
#define volumicLabelMaps_h

#include "LabelShapes.h"

#include <map>
#include <string>
#include <vector>

namespace volumic::bench
{

/**
 * A label map from a .vti, .nii or .nii.gz, its axes along those of the world. Throws
 * std::runtime_error for what is none: voxels that are no whole numbers of 16 bits.
 */
support::LabelMap ReadLabelMap(const std::string& file);

/**
 * Labels of a scan as a quick segmentation makes them: a median of 3 x 3 x 3 voxels; label 1 from
 * the first threshold on, 2 from the second, ...; what is connected (by sides) and of less than
 * 200 voxels is background, 0.
 */
support::LabelMap LabelsOfScan(const std::string& file, const std::vector<double>& thresholds);

/** 1 where the map is more than the background, 0. */
support::LabelMap MaskOf(support::LabelMap map);

/** Voxels of each label but the background. */
std::map<int, long long> CountLabels(const support::LabelMap& map);

/** The box of a label with `margin` voxels about it, those outside of the map background. */
support::LabelMap CropToLabel(const support::LabelMap& map, int label, int margin);

} // namespace volumic::bench

#endif

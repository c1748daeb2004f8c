// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicReadVolume_h
#define volumicReadVolume_h

#include "Host/RunObserver.h"
#include "Pyramid/ImageLevels.h"
#include "Settings/SegmentationSettings.h"

#include <string>

namespace volumic
{
/** Prefixes of messages about the voxels and about the edge map. */
constexpr const char* VoxelErrorPrefix = "Input port 0: ";
constexpr const char* EdgeErrorPrefix = "Input port 0, edge map: ";

/** The data of input port 0 as levels. */
struct Volume
{
  ImageLevels Voxels;
  ImageLevels Edges;        ///< of the edge map; empty if its weight is 0
  bool IsOfImage = false;   ///< The input was an image, and EdgeLength is applied to the levels.
  std::string HintAtLabels; ///< warning for voxels that look like labels; empty: none

  bool IsComplete() const { return this->Voxels.IsComplete && this->Edges.IsComplete; }
};

/**
 * Compute the levels of an image, or read the blocks of a pyramid. For an image set the automatic
 * settings of the request: the iso-value, and the finest level for EdgeLength. The result is
 * incomplete if `progress` has returned false.
 * @throws InvalidArgument naming the port or the property
 */
Volume ReadVolume(SegmentationRequest& request, const Progress& progress);
}

#endif

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
/** What messages about the voxels, and about the map of edges, begin with. */
constexpr const char* PlaceOfVoxels = "Input port 0: ";
constexpr const char* PlaceOfEdges = "Input port 0, the map of edges: ";

/** What input port 0 holds, as levels. */
struct Volume
{
  ImageLevels Voxels;
  ImageLevels Edges;        ///< of the map of edges, where the settings give it a weight
  bool IsOfImage = false;   ///< The levels were made here, by EdgeLength if there is one.
  std::string HintAtLabels; ///< what to tell if the voxels look like labels

  bool IsComplete() const { return this->Voxels.IsComplete && this->Edges.IsComplete; }
};

/**
 * Makes the levels of an image, or takes the blocks of a pyramid, and sets what the request's
 * settings find for them: the iso-value, the finest level. After a stop levels are missing.
 * @throws std::invalid_argument naming the port or the property
 */
Volume ReadVolume(SegmentationRequest& request, const Progress& progress);
}

#endif

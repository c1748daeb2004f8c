// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLevelPlaces_h
#define volumicLevelPlaces_h

#include <vector>

class vtkImageData;
class vtkMultiBlockDataSet;

namespace volumic
{
/** What messages about blocks that are no levels end with. */
inline constexpr const char* LevelsWayOut =
  " Give the output of Image Pyramid, or the image itself.";

/**
 * Looks whether an image is level h of the pyramid of level 0, by its size and place.
 * @param below level h - 1
 * @throws std::invalid_argument naming the block and the way out if it is not.
 */
void CheckPlace(vtkImageData* level0, vtkImageData* below, vtkImageData* image, unsigned int h);

/** Whether they are the levels of a pyramid (two at least), by their sizes and places. */
bool AreLevels(const std::vector<vtkImageData*>& images);

/** Level 0 if the blocks are the levels of a pyramid (two at least), else null. */
vtkImageData* Level0OfPyramid(vtkMultiBlockDataSet* blocks);
}

#endif

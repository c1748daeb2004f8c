// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicRunLevels_h
#define volumicRunLevels_h

#include "Settings/SegmentationSettings.h"

#include <cstddef>
#include <functional>
#include <string>

class vtkAlgorithm;
class vtkDataObject;

namespace volumic
{
/** Where the voxels of a run come from, and whom their reading tells. */
struct VoxelSource
{
  vtkAlgorithm* Filter = nullptr; ///< to whose input port 0 they come
  std::size_t MemoryLimit = 0;    ///< bytes; 0: none, or it is kept already
  /** Told the share that is done, and what is being done; false asks to stop. */
  std::function<bool(double share, const char* text)> GoOn;
  /** Told what is worth a warning of port 0 once in a filter's life, or nothing; `what` says which.
   */
  std::function<void(const char* what, const std::string& text)> WarnOnce;
};

/** Whether the data of input port 0 are an image, of which the levels are still to be made. */
bool IsImage(vtkDataObject* input);

/**
 * Sets the levels of a request, of the data of input port 0, and what its settings find for them:
 * an image comes in slabs where the memory is limited and its source can. After a stop they are
 * null.
 * @throws std::invalid_argument naming the port or the property
 */
void SetLevels(SegmentationRequest& request, vtkDataObject* input, const VoxelSource& source);
}

#endif

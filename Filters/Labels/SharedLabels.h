// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSharedLabels_h
#define volumicSharedLabels_h

#include "Core/Common/Communicator.h"
#include "Core/Labels/LabelMap.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkImageData;

namespace volumic
{
/** What each rank has to know of a label map to make surfaces of its labels. */
struct SharedLabels
{
  LabelMap Map;
  vtkSmartPointer<vtkImageData> Frame; ///< where the voxels are; its arrays don't matter
  std::vector<std::string> Names;      ///< of the surfaces

  /** By all ranks: gives them what rank 0 has. */
  void Share(Communicator& ranks);
};
}

#endif

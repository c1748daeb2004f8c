// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicOtsuThreshold_h
#define volumicOtsuThreshold_h

#include "Core/Common/Communicator.h"

class vtkImageData;
class vtkInformation;

namespace volumic
{
/**
 * What vtkOtsuThreshold finds. By all ranks together: the same on all, however many they are.
 * @param image     this rank's piece; null: none
 * @param selection of the voxels, as GetInputArrayInformation()
 * @throws std::invalid_argument where there is no such value.
 */
double FindOtsuThreshold(
  Communicator& ranks, vtkImageData* image, vtkInformation* selection, int component);
}

#endif

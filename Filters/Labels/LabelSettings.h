// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSettings_h
#define volumicLabelSettings_h

#include "Core/Common/Grading.h"
#include "Core/Labels/LabelField.h"
#include "Core/Labels/LabelMap.h"

#include <algorithm>

class vtkImageData;
namespace volumic
{
/** Properties of vtkLabelsToSurfaces, except the choice of labels. Numbers may be out of range. */
struct LabelSettings
{
  double Smoothing = 2.0; ///< in smallest voxel spacings, or in 5/8 of the largest if that is more
  /** In smallest voxel spacings. -1: a quarter of Smoothing, at most 1. */
  double VoxelTolerance = -1.0;
  int BoxFaces = 0; ///< 0 rounded, 1 flat, 2 periodic
  int Metric = 1;
  double EdgeLength = 0.0;
  volumic::Grading Grading;
  int FinestLevel = 0;
  int KeepComponents = 0;
  double MinimumComponentVolume = 0.0;

  bool HasFlatBox() const { return this->BoxFaces != 0; }
  double VoxelToleranceInUse() const
  {
    return this->VoxelTolerance == -1.0 ? std::min(1.0, 0.25 * this->Smoothing)
                                        : this->VoxelTolerance;
  }
  bool IsPeriodic() const { return this->BoxFaces == 2; }

  /**
   * @param image geometry of the label map
   * @throws InvalidArgument naming a property that is out of range
   */
  void Check(vtkImageData* image) const;

  LabelFieldOptions FieldOptions(const LabelMap& map) const;
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSettings_h
#define volumicLabelSettings_h

#include "Core/Common/Grading.h"

namespace volumic
{
/** What vtkLabelsToSurfaces is asked for, but for which labels. Numbers may be out of range. */
struct LabelSettings
{
  double Smoothing = 2.0;      ///< smallest distances of voxels, or 5/8 of the longest
  double VoxelTolerance = 0.5; ///< smallest distances of voxels
  double Gap = 0.0;            ///< world units
  bool SharedInterfaces = false;
  int BoxFaces = 0; ///< where labels reach the border of the image: 0 rounded, 1 flat, 2 periodic
  int Metric = 1;
  double EdgeLength = 0.0;
  volumic::Grading Grading;
  int FinestLevel = 0;
  int KeepComponents = 0;
  double MinimumComponentVolume = 0.0;

  bool HasFlatBox() const { return this->BoxFaces != 0; }
  bool IsPeriodic() const { return this->BoxFaces == 2; }

  /**
   * @param unit the smallest distance of voxels, world units
   * @throws std::invalid_argument naming the property that is out of range.
   */
  void Check(double unit) const;
};

}

#endif

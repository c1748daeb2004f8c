// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSegmentationVolume_h
#define volumicSegmentationVolume_h

#include "Settings/SegmentationSettings.h"

#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>

namespace volumic
{
/** The levels that a surface is searched in, and how. */
struct SegmentationVolume
{
  vtkSmartPointer<vtkMultiBlockDataSet> Levels; ///< null where their making was stopped
  vtkSmartPointer<vtkInformation> Selection; ///< of the voxels, as GetInputArrayInformation()
  /** As set, but for what was found for this image: iso-value, and what EdgeLength asks for. */
  SegmentationSettings Settings;
  double FactorBelowLevel0 = 1.7320508075688772; ///< U_0 over the unit of level -1
  bool EdgeLengthIsPlanned = false; ///< The levels were made for it, and what follows is set.
  bool LevelsAreOwn = false; ///< Made for this run: nobody was told of their NaN voxels.
};
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicLabelSurface_h
#define volumicLabelSurface_h

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkPolyData;

namespace volumic
{
/** The surface of one object of a label map. */
struct LabelSurface
{
  vtkSmartPointer<vtkPolyData> Surface; ///< null: the run was stopped before there was one
  vtkIdType WrongVoxels = 0;            ///< misclassified voxels
  vtkIdType MissedVoxels = 0; ///< misclassified voxels further from the surface than the tolerances
  double VolumeError = 0.0;   ///< enclosed volume over the voxels' volume, less 1
  bool IsFinished = false;    ///< The run was not stopped.
};
}

#endif

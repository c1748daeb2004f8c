// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceOutput_h
#define volumicSurfaceOutput_h

#include "Core/Common/Executor.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Input/ComputationalSpace.h"
#include "Output/KeepComponents.h"

#include <vtkSmartPointer.h>

#include <initializer_list>
#include <string>

class vtkFieldData;
class vtkPolyData;

namespace volumic
{
/** Values for the field data of a surface. */
struct SurfaceDescription
{
  int Level = 0;
  int StartLevel = 0;       ///< of the run
  double Unit = 0.0;        ///< U_h, world units
  int Iterations = 0;       ///< at this level
  int TotalIterations = -1; ///< over all levels; field `Iteration`, -1: none
  std::string StopReason;   ///< empty: none, for a snapshot
  MissedParts Missed;
};

/**
 * Return the selected components in world coordinates with all arrays that vtkDeformableSurface
 * documents. Each array of a moved surface is freed after it is copied.
 */
vtkSmartPointer<vtkPolyData> MakePolyData(SurfaceResult result,
  const SurfaceDescription& description, const ComputationalSpace& space,
  const ComponentChoice& choice = ComponentChoice(), Executor& executor = OnThisThread());

/** Set vtkAbstractArray::GUI_HIDE(), so that ParaView does not list the arrays. */
void HideArrays(vtkFieldData* arrays, std::initializer_list<const char*> names);

/** Replace `StopReason`. Shallow copies of the surface keep theirs. */
void SetStopReason(vtkPolyData* surface, const std::string& reason);

/** Return an empty surface with all arrays, for a run that was stopped at its start. */
vtkSmartPointer<vtkPolyData> MakeStopped(int level, const std::string& reason);
}

#endif

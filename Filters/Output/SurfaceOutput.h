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
/** What is told of a surface beside its geometry. */
struct SurfaceDescription
{
  int Level = 0;
  int StartLevel = 0;       ///< of the run
  double Unit = 0.0;        ///< U_h, world units
  int Iterations = 0;       ///< at this level
  int TotalIterations = -1; ///< over all levels; field `Iteration`, -1: none
  std::string StopReason;   ///< empty: none, the surface is still on its way
  MissedParts Missed;
};

/**
 * Return the selected components in world coordinates with all arrays that vtkDeformableSurface
 * documents. Each array of a moved surface is freed once it is copied.
 */
vtkSmartPointer<vtkPolyData> MakePolyData(SurfaceResult given,
  const SurfaceDescription& description, const ComputationalSpace& space,
  const ComponentChoice& choice = ComponentChoice(), Executor& executor = OnThisThread());

/** Set vtkAbstractArray::GUI_HIDE(): ParaView does not offer the arrays for a choice. */
void HideArrays(vtkFieldData* arrays, std::initializer_list<const char*> names);

/** Sets `StopReason` instead of the one that it has; what it was copied from keeps its own. */
void SetStopReason(vtkPolyData* surface, const std::string& reason);

/** The surface of a run that was stopped before it had one: empty, with all its arrays. */
vtkSmartPointer<vtkPolyData> MakeStopped(int level, const std::string& reason);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFields_h
#define volumicSurfaceFields_h

#include "VolumeImage.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkUnsignedCharArray;

namespace tool
{
/** Call `take(polygon, corners, count)` for each polygon of a surface, from the first one on. */
template <class Take>
void ForEachPolygon(vtkPolyData* surface, const Take& take)
{
  const auto cells = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCurrentCell(count, corners);
    take(cells->GetCurrentCellId(), corners, count);
  }
}

/** A label that a surface of vtkLabelsToSurfaces is about. */
struct SurfaceLabel
{
  int Label = 0;
  std::string Name;
  Vector3 Color = { 0.0, 0.0, 0.0 }; ///< 0 to 1, as screens have it (sRGB)
};

/** The `StopReason` of a surface of vtkDeformableSurface. */
std::string StopReason(vtkPolyData* surface);

/** Of the surface's field data; none if it is not about labels. */
std::vector<SurfaceLabel> LabelsOf(vtkPolyData* surface);

/** The label of each triangle; null if the surface is not about labels. */
const int* TriangleLabels(vtkPolyData* surface);

/** A colour for each vertex, that of the first triangle about it; null as above. */
vtkSmartPointer<vtkUnsignedCharArray> VertexColors(vtkPolyData* surface);
}

#endif

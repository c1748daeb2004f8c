// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef volumicSurfaceFacts_h
#define volumicSurfaceFacts_h

#include "VolumeImage.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <string>
#include <vector>

class vtkMultiBlockDataSet;
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

using Floats = std::array<float, 3>;

/** Three numbers as binary files have them. */
inline Floats AsFloats(const double* numbers)
{
  return { static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
    static_cast<float>(numbers[2]) };
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

// ---- Sizes --------------------------------------------------------------------------------------

struct SurfaceSize
{
  vtkIdType Vertices = 0;
  vtkIdType Triangles = 0;
};

/** @param surface may be null */
SurfaceSize SizeOf(vtkPolyData* surface);

/** Of each block. */
std::vector<SurfaceSize> SizesOf(vtkMultiBlockDataSet* blocks);
}

#endif

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PolyDataPoints.h"

#include "Core/Common/Refuse.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstddef>
#include <numeric>

namespace volumic
{
std::vector<vtkIdType> PointsMeantBy(vtkPolyData* polyData)
{
  const auto numberOfPoints = static_cast<std::size_t>(polyData->GetNumberOfPoints());
  std::vector<vtkIdType> ids;
  if (polyData->GetNumberOfCells() == 0)
  {
    ids.resize(numberOfPoints);
    std::iota(ids.begin(), ids.end(), vtkIdType(0));
    return ids;
  }
  if (polyData->GetNumberOfVerts() == 0)
  {
    Refuse("Points are wanted, but the data has lines or polygons and no vertices. Mark the points "
           "by vertices (vtkVertexGlyphFilter, in ParaView Convert To Point Cloud), or give them "
           "without any cells.");
  }
  std::vector<bool> isTaken(numberOfPoints, false);
  auto cells = vtk::TakeSmartPointer(polyData->GetVerts()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType size;
    const vtkIdType* points;
    cells->GetCurrentCell(size, points);
    for (vtkIdType i = 0; i < size; ++i)
    {
      if (!isTaken[points[i]])
      {
        isTaken[points[i]] = true;
        ids.push_back(points[i]);
      }
    }
  }
  return ids;
}

bool IsSurfaceOnly(vtkPolyData* polyData)
{
  return polyData->GetNumberOfPolys() + polyData->GetNumberOfStrips() > 0 &&
    polyData->GetNumberOfVerts() == 0;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/CellIndices.h"

#include "Core/Common/Refuse.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <algorithm>

namespace volumic
{
std::string FaultOfCells(vtkPolyData* data)
{
  const vtkIdType points = data->GetNumberOfPoints();
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    if (cells->GetNumberOfCells() > 0 && !cells->IsValid())
    {
      return "is damaged: its cells overlap.";
    }
    auto each = vtk::TakeSmartPointer(cells->NewIterator());
    for (each->GoToFirstCell(); !each->IsDoneWithTraversal(); each->GoToNextCell())
    {
      vtkIdType size;
      const vtkIdType* ids;
      each->GetCurrentCell(size, ids);
      const auto wrong =
        std::find_if(ids, ids + size, [points](vtkIdType id) { return id < 0 || id >= points; });
      if (wrong != ids + size)
      {
        return Join("is damaged: a cell has point ", *wrong, ", there are ", points, ".");
      }
    }
  }
  return "";
}
}

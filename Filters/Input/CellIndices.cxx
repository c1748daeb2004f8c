// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/CellIndices.h"

#include "Core/Common/Refuse.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkType.h>

namespace volumic
{
std::string FaultOfCells(vtkPolyData* data)
{
  const vtkIdType points = data->GetNumberOfPoints();
  for (vtkCellArray* cells :
    { data->GetVerts(), data->GetLines(), data->GetPolys(), data->GetStrips() })
  {
    if (!cells->IsValid())
    {
      return "is damaged: its cells overlap.";
    }
    double range[2] = { 0.0, -1.0 };
    if (cells->GetNumberOfConnectivityIds() > 0)
    {
      cells->GetConnectivityArray()->GetRange(range, 0);
    }
    if (range[0] < 0.0 || range[1] >= static_cast<double>(points))
    {
      return Join("is damaged: a cell has point ", range[0] < 0.0 ? range[0] : range[1],
        ", there are ", points, ".");
    }
  }
  return "";
}
}

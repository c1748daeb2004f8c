// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/JoinSurfaces.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
bool HasPolygons(vtkPolyData* data)
{
  return data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0;
}

/** Whether all have global ids of their points. */
bool HaveIds(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
{
  return std::all_of(pieces.begin(), pieces.end(),
    [](vtkPolyData* piece) { return piece->GetPointData()->GetGlobalIds() != nullptr; });
}

/** The polygons, with the points of each id as one. */
vtkSmartPointer<vtkPolyData> MergeById(vtkPolyData* joined)
{
  vtkDataArray* ids = joined->GetPointData()->GetGlobalIds();
  std::vector<std::pair<vtkIdType, vtkIdType>> order;
  for (vtkIdType p = 0; p < ids->GetNumberOfTuples(); ++p)
  {
    order.emplace_back(static_cast<vtkIdType>(ids->GetComponent(p, 0)), p);
  }
  std::sort(order.begin(), order.end());
  auto merged = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(joined->GetPoints()->GetDataType());
  std::vector<vtkIdType> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    if (i == 0 || order[i].first != order[i - 1].first)
    {
      points->InsertNextPoint(joined->GetPoint(order[i].second));
    }
    place[static_cast<std::size_t>(order[i].second)] = points->GetNumberOfPoints() - 1;
  }
  const auto renumber = [&place](vtkCellArray* cells)
  {
    auto renumbered = vtkSmartPointer<vtkCellArray>::New();
    vtkNew<vtkIdList> corners;
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      cells->GetCellAtId(cell, corners);
      for (vtkIdType& corner : *corners)
      {
        corner = place[static_cast<std::size_t>(corner)];
      }
      renumbered->InsertNextCell(corners);
    }
    return renumbered;
  };
  merged->SetPoints(points);
  merged->SetVerts(renumber(joined->GetVerts()));
  merged->SetLines(renumber(joined->GetLines()));
  merged->SetPolys(renumber(joined->GetPolys()));
  merged->SetStrips(renumber(joined->GetStrips()));
  return merged;
}

vtkSmartPointer<vtkPolyData> MergeByPlace(vtkPolyData* joined)
{
  constexpr double tolerance = 1e-6; // Sources that give pieces round the border of each anew.
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(joined);
  clean->SetTolerance(tolerance);
  clean->PieceInvariantOff();
  clean->Update();
  return clean->GetOutput();
}

/** Whether two have the same points, bit by bit. */
bool AreTheSame(vtkPolyData* a, vtkPolyData* b)
{
  const std::size_t bytes = static_cast<std::size_t>(a->GetNumberOfPoints()) * 3 *
    static_cast<std::size_t>(a->GetPoints()->GetData()->GetDataTypeSize());
  return a->GetNumberOfPoints() == b->GetNumberOfPoints() &&
    a->GetPoints()->GetDataType() == b->GetPoints()->GetDataType() &&
    a->GetNumberOfCells() == b->GetNumberOfCells() &&
    std::memcmp(a->GetPoints()->GetVoidPointer(0), b->GetPoints()->GetVoidPointer(0), bytes) == 0;
}
}

vtkSmartPointer<vtkPolyData> OwnPartOf(vtkPolyData* piece)
{
  auto own = vtkSmartPointer<vtkPolyData>::New();
  own->ShallowCopy(piece);
  if (piece->GetNumberOfCells() > 0)
  {
    if (own->GetCellGhostArray())
    {
      own->RemoveGhostCells();
    }
    return own;
  }
  vtkUnsignedCharArray* types = piece->GetPointGhostArray();
  vtkNew<vtkPoints> points;
  points->SetDataType(piece->GetPoints()->GetDataType());
  own->Initialize();
  own->GetPointData()->CopyAllocate(piece->GetPointData(), piece->GetNumberOfPoints());
  for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
  {
    if (!types || !(types->GetValue(p) & vtkDataSetAttributes::DUPLICATEPOINT))
    {
      own->GetPointData()->CopyData(
        piece->GetPointData(), p, points->InsertNextPoint(piece->GetPoint(p)));
    }
  }
  own->SetPoints(points);
  return own;
}

vtkSmartPointer<vtkPolyData> JoinSurfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& given)
{
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  vtkNew<vtkAppendPolyData> append;
  for (vtkPolyData* of : given)
  {
    if (!of || of->GetNumberOfPoints() == 0)
    {
      continue;
    }
    const vtkSmartPointer<vtkPolyData> piece = OwnPartOf(of);
    if (piece->GetNumberOfPoints() > 0 &&
      std::none_of(pieces.begin(), pieces.end(),
        [&piece](vtkPolyData* other) { return AreTheSame(piece, other); }))
    {
      pieces.push_back(piece);
      append->AddInputData(piece);
    }
  }
  const bool isFirst =
    given.front() && given.front()->GetNumberOfPoints() > 0 && pieces.size() == 1;
  if (pieces.empty() || isFirst)
  {
    return given.front() ? given.front() : vtkSmartPointer<vtkPolyData>::New();
  }
  if (pieces.size() == 1)
  {
    return pieces.front();
  }
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->Update();
  vtkPolyData* joined = append->GetOutput();
  if (!HasPolygons(joined))
  {
    return joined;
  }
  return HaveIds(pieces) ? MergeById(joined) : MergeByPlace(joined);
}
}

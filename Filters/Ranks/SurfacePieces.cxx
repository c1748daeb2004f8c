// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/SurfacePieces.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace volumic
{
namespace
{
std::array<vtkIdType, 3> CornersOf(vtkPolyData* surface, vtkIdType triangle)
{
  vtkIdType size;
  const vtkIdType* ids;
  surface->GetPolys()->GetCellAtId(triangle, size, ids);
  return { ids[0], ids[1], ids[2] };
}

/** Some tuples of all arrays, which keep their types, names and roles. */
void CopyTuples(
  vtkDataSetAttributes* from, const std::vector<vtkIdType>& ids, vtkDataSetAttributes* to)
{
  vtkNew<vtkIdList> of;
  vtkNew<vtkIdList> at;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    of->InsertNextId(ids[i]);
    at->InsertNextId(static_cast<vtkIdType>(i));
  }
  to->CopyAllOn();
  to->CopyAllocate(from, of->GetNumberOfIds());
  to->SetNumberOfTuples(of->GetNumberOfIds());
  to->CopyData(from, of, at);
}

/** @param corners three of each triangle */
vtkSmartPointer<vtkCellArray> TrianglesAt(const std::vector<vtkIdType>& corners)
{
  // As SurfaceOutput makes them.
  vtkNew<vtkIdTypeArray> connectivity;
  connectivity->SetNumberOfTuples(static_cast<vtkIdType>(corners.size()));
  std::copy(corners.begin(), corners.end(), connectivity->GetPointer(0));
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfTuples(static_cast<vtkIdType>(corners.size() / 3 + 1));
  for (vtkIdType t = 0; t < offsets->GetNumberOfTuples(); ++t)
  {
    offsets->SetValue(t, 3 * t);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

/** Tells what is another rank's. */
template <typename IsDuplicate>
void AddGhostTypes(vtkDataSetAttributes* attributes, std::size_t count, unsigned char duplicate,
  const IsDuplicate& isDuplicate)
{
  vtkNew<vtkUnsignedCharArray> types;
  types->SetName(vtkDataSetAttributes::GhostArrayName());
  types->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    types->SetValue(static_cast<vtkIdType>(i), isDuplicate(i) ? duplicate : 0);
  }
  attributes->AddArray(types);
}
}

SurfacePieces::SurfacePieces(vtkPolyData* whole, int numberOfPieces, int ghostLevels)
  : Whole(whole), NumberOfPieces(numberOfPieces), GhostLevels(ghostLevels)
{
  if (ghostLevels <= 0 || !whole)
  {
    return;
  }
  const vtkIdType triangles = whole->GetNumberOfPolys();
  this->FirstOfPoint.resize(static_cast<std::size_t>(whole->GetNumberOfPoints()) + 1, 0);
  for (vtkIdType t = 0; t < triangles; ++t)
  {
    for (const vtkIdType corner : CornersOf(whole, t))
    {
      ++this->FirstOfPoint[static_cast<std::size_t>(corner)];
    }
  }
  // The end of each point's triangles, which becomes their begin as they are put in from behind.
  vtkIdType end = 0;
  for (vtkIdType& ofPoint : this->FirstOfPoint)
  {
    ofPoint = end += ofPoint;
  }
  this->TrianglesOfPoints.resize(static_cast<std::size_t>(3 * triangles));
  for (vtkIdType t = triangles - 1; t >= 0; --t)
  {
    for (const vtkIdType corner : CornersOf(whole, t))
    {
      const vtkIdType place = --this->FirstOfPoint[static_cast<std::size_t>(corner)];
      this->TrianglesOfPoints[static_cast<std::size_t>(place)] = t;
    }
  }
}

std::vector<vtkIdType> SurfacePieces::TrianglesOf(int number, vtkIdType& numberOfOwn) const
{
  const vtkIdType count = this->Whole->GetNumberOfPolys();
  const vtkIdType begin = count * number / this->NumberOfPieces;
  const vtkIdType end = count * (number + 1) / this->NumberOfPieces;
  numberOfOwn = end - begin;
  std::vector<vtkIdType> triangles(static_cast<std::size_t>(numberOfOwn));
  std::iota(triangles.begin(), triangles.end(), begin);
  if (this->GhostLevels <= 0)
  {
    return triangles;
  }
  std::vector<bool> isThere(static_cast<std::size_t>(count), false);
  std::fill(isThere.begin() + begin, isThere.begin() + end, true);
  std::vector<vtkIdType> layer = triangles;
  for (int level = 0; level < this->GhostLevels; ++level)
  {
    std::vector<vtkIdType> next;
    for (const vtkIdType triangle : layer)
    {
      for (const vtkIdType corner : CornersOf(this->Whole, triangle))
      {
        const auto point = static_cast<std::size_t>(corner);
        for (vtkIdType p = this->FirstOfPoint[point]; p < this->FirstOfPoint[point + 1]; ++p)
        {
          const vtkIdType other = this->TrianglesOfPoints[static_cast<std::size_t>(p)];
          if (!isThere[static_cast<std::size_t>(other)])
          {
            isThere[static_cast<std::size_t>(other)] = true;
            next.push_back(other);
          }
        }
      }
    }
    triangles.insert(triangles.end(), next.begin(), next.end());
    layer = std::move(next);
  }
  std::sort(triangles.begin() + numberOfOwn, triangles.end());
  return triangles;
}

vtkSmartPointer<vtkPolyData> SurfacePieces::Piece(int number) const
{
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  vtkIdType numberOfOwn = 0;
  const std::vector<vtkIdType> triangles = this->TrianglesOf(number, numberOfOwn);
  std::vector<vtkIdType> corners;
  for (const vtkIdType t : triangles)
  {
    const std::array<vtkIdType, 3> ofTriangle = CornersOf(this->Whole, t);
    corners.insert(corners.end(), ofTriangle.begin(), ofTriangle.end());
  }
  std::vector<vtkIdType> points = corners;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (vtkIdType& corner : corners)
  {
    corner = std::lower_bound(points.begin(), points.end(), corner) - points.begin();
  }

  piece->SetPolys(TrianglesAt(corners));
  vtkNew<vtkPoints> places;
  places->SetDataType(this->Whole->GetPoints()->GetDataType());
  for (const vtkIdType point : points)
  {
    places->InsertNextPoint(this->Whole->GetPoint(point));
  }
  piece->SetPoints(places);
  CopyTuples(this->Whole->GetPointData(), points, piece->GetPointData());
  CopyTuples(this->Whole->GetCellData(), triangles, piece->GetCellData());
  piece->GetFieldData()->ShallowCopy(this->Whole->GetFieldData());

  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("GlobalIds");
  ids->SetNumberOfTuples(static_cast<vtkIdType>(points.size()));
  std::copy(points.begin(), points.end(), ids->GetPointer(0));
  piece->GetPointData()->SetGlobalIds(ids);
  if (this->GhostLevels > 0)
  {
    std::vector<bool> isOwn(points.size(), false);
    for (vtkIdType i = 0; i < 3 * numberOfOwn; ++i)
    {
      isOwn[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])] = true;
    }
    AddGhostTypes(piece->GetPointData(), points.size(), vtkDataSetAttributes::DUPLICATEPOINT,
      [&isOwn](std::size_t p) { return !isOwn[p]; });
    AddGhostTypes(piece->GetCellData(), triangles.size(), vtkDataSetAttributes::DUPLICATECELL,
      [numberOfOwn](std::size_t t) { return static_cast<vtkIdType>(t) >= numberOfOwn; });
  }
  return piece;
}
}

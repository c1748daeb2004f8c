// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/CutData.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkExtentTranslator.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

namespace volumic
{
namespace
{
using Ids = std::vector<vtkIdType>;

std::array<vtkIdType, 3> CornersOf(vtkPolyData* surface, vtkIdType triangle)
{
  vtkIdType size;
  const vtkIdType* ids;
  surface->GetPolys()->GetCellAtId(triangle, size, ids);
  return { ids[0], ids[1], ids[2] };
}

/** Some tuples of all arrays, which keep their types, names and roles. */
void CopyTuples(vtkDataSetAttributes* from, const Ids& ids, vtkDataSetAttributes* to)
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

/** Tells what is another rank's. */
void AddGhostTypes(
  vtkDataSetAttributes* attributes, const std::vector<bool>& isOwn, unsigned char duplicate)
{
  vtkNew<vtkUnsignedCharArray> types;
  types->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const bool own : isOwn)
  {
    types->InsertNextValue(own ? 0 : duplicate);
  }
  attributes->AddArray(types);
}

/** Its own triangles, then those of the ghost layers. */
Ids TrianglesOf(vtkPolyData* whole, const Cut& cut, std::size_t& numberOfOwn)
{
  const vtkIdType count = whole->GetNumberOfPolys();
  const vtkIdType begin = count * cut.Number / cut.Count;
  const vtkIdType end = count * (cut.Number + 1) / cut.Count;
  numberOfOwn = static_cast<std::size_t>(end - begin);
  Ids triangles(numberOfOwn);
  std::iota(triangles.begin(), triangles.end(), begin);
  std::vector<bool> isThere(static_cast<std::size_t>(count), false);
  std::vector<bool> isNear(static_cast<std::size_t>(whole->GetNumberOfPoints()), false);
  std::size_t layer = 0; // It begins there.
  for (int level = 0; level < cut.Ghosts; ++level)
  {
    for (; layer < triangles.size(); ++layer)
    {
      isThere[static_cast<std::size_t>(triangles[layer])] = true;
      for (const vtkIdType corner : CornersOf(whole, triangles[layer]))
      {
        isNear[static_cast<std::size_t>(corner)] = true;
      }
    }
    for (vtkIdType t = 0; t < count; ++t)
    {
      const std::array<vtkIdType, 3> corners = CornersOf(whole, t);
      if (!isThere[static_cast<std::size_t>(t)] &&
        std::any_of(corners.begin(), corners.end(),
          [&isNear](vtkIdType corner) { return isNear[static_cast<std::size_t>(corner)]; }))
      {
        triangles.push_back(t);
      }
    }
  }
  std::sort(triangles.begin() + static_cast<std::ptrdiff_t>(numberOfOwn), triangles.end());
  return triangles;
}

vtkSmartPointer<vtkPolyData> CutSurface(vtkPolyData* whole, const Cut& cut)
{
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  if (cut.IsEmpty)
  {
    return piece;
  }
  piece->GetFieldData()->ShallowCopy(whole->GetFieldData());
  if (!whole->GetPoints())
  {
    return piece;
  }
  std::size_t numberOfOwn = 0;
  const Ids triangles = TrianglesOf(whole, cut, numberOfOwn);
  Ids corners;
  for (const vtkIdType t : triangles)
  {
    const std::array<vtkIdType, 3> ofTriangle = CornersOf(whole, t);
    corners.insert(corners.end(), ofTriangle.begin(), ofTriangle.end());
  }
  Ids points = corners;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  vtkNew<vtkCellArray> cells;
  std::vector<bool> isOwnPoint(points.size(), false);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    vtkIdType ofPiece[3];
    for (std::size_t c = 0; c < 3; ++c)
    {
      ofPiece[c] =
        std::lower_bound(points.begin(), points.end(), corners[3 * t + c]) - points.begin();
      isOwnPoint[static_cast<std::size_t>(ofPiece[c])] =
        isOwnPoint[static_cast<std::size_t>(ofPiece[c])] || t < numberOfOwn;
    }
    cells->InsertNextCell(3, ofPiece);
  }
  vtkNew<vtkPoints> places;
  places->SetDataType(whole->GetPoints()->GetDataType());
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("GlobalIds");
  for (const vtkIdType point : points)
  {
    places->InsertNextPoint(whole->GetPoint(point));
    ids->InsertNextValue(point);
  }
  piece->SetPoints(places);
  piece->SetPolys(cells);
  CopyTuples(whole->GetPointData(), points, piece->GetPointData());
  CopyTuples(whole->GetCellData(), triangles, piece->GetCellData());
  piece->GetPointData()->SetGlobalIds(ids);
  if (cut.Ghosts > 0)
  {
    std::vector<bool> isOwn(triangles.size(), false);
    std::fill_n(isOwn.begin(), numberOfOwn, true);
    AddGhostTypes(piece->GetPointData(), isOwnPoint, vtkDataSetAttributes::DUPLICATEPOINT);
    AddGhostTypes(piece->GetCellData(), isOwn, vtkDataSetAttributes::DUPLICATECELL);
  }
  return piece;
}

vtkSmartPointer<vtkImageData> CutImage(vtkImageData* image, const Cut& cut)
{
  int whole[6];
  int own[6];
  int extent[6];
  image->GetExtent(whole);
  vtkNew<vtkExtentTranslator> translator;
  constexpr int mode = vtkExtentTranslator::BLOCK_MODE;
  if (!translator->PieceToExtentThreadSafe(cut.Number, cut.Count, 0, whole, own, mode, 0) ||
    !translator->PieceToExtentThreadSafe(cut.Number, cut.Count, cut.Ghosts, whole, extent, mode, 0))
  {
    return nullptr;
  }
  auto piece = vtkSmartPointer<vtkImageData>::New();
  piece->ShallowCopy(image);
  piece->Crop(extent);
  if (cut.Ghosts > 0)
  {
    piece->GenerateGhostArray(own);
  }
  return piece;
}

vtkSmartPointer<vtkMultiBlockDataSet> CutBlocks(vtkMultiBlockDataSet* whole, const Cut& cut)
{
  auto pieces = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  pieces->GetFieldData()->ShallowCopy(whole->GetFieldData());
  pieces->SetNumberOfBlocks(whole->GetNumberOfBlocks());
  for (unsigned int block = 0; block < whole->GetNumberOfBlocks(); ++block)
  {
    pieces->SetBlock(block, CutData(whole->GetBlock(block), cut));
    if (whole->HasMetaData(block))
    {
      pieces->GetMetaData(block)->Copy(whole->GetMetaData(block));
    }
  }
  return pieces;
}
}

vtkSmartPointer<vtkDataObject> CutData(vtkDataObject* whole, const Cut& cut)
{
  if (auto* surface = vtkPolyData::SafeDownCast(whole))
  {
    return CutSurface(surface, cut);
  }
  if (auto* image = vtkImageData::SafeDownCast(whole))
  {
    return CutImage(image, cut);
  }
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(whole))
  {
    return CutBlocks(blocks, cut);
  }
  auto* table = vtkTable::SafeDownCast(whole);
  if (!table || cut.Number == 0)
  {
    return whole;
  }
  auto columns = vtkSmartPointer<vtkTable>::New();
  CopyTuples(table->GetRowData(), {}, columns->GetRowData());
  return columns;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Pieces.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
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
#include <cstddef>
#include <cstring>
#include <map>
#include <numeric>

namespace volumic
{
namespace
{
/** Tells which are another rank's: those after its own. */
void AddGhostTypes(
  vtkDataSetAttributes* attributes, vtkIdType count, vtkIdType own, unsigned char duplicate)
{
  vtkNew<vtkUnsignedCharArray> types;
  types->SetName(vtkDataSetAttributes::GhostArrayName());
  types->SetNumberOfTuples(count);
  std::fill_n(types->GetPointer(0), own, static_cast<unsigned char>(0));
  std::fill_n(types->GetPointer(own), count - own, duplicate);
  attributes->AddArray(types);
}

/** Its own triangles, from the first one on, then those of the ghost layers. */
vtkSmartPointer<vtkIdList> TrianglesOf(vtkPolyData* whole, const Cut& cut, vtkIdType numberOfOwn)
{
  const vtkIdType count = whole->GetNumberOfPolys();
  const vtkIdType first = count * cut.Number / cut.Count;
  auto triangles = vtkSmartPointer<vtkIdList>::New();
  triangles->SetNumberOfIds(numberOfOwn);
  std::iota(triangles->begin(), triangles->end(), first);
  std::vector<bool> isNear(static_cast<std::size_t>(whole->GetNumberOfPoints()), false);
  vtkNew<vtkIdList> corners;
  for (int level = 0; level < cut.Ghosts; ++level)
  {
    for (const vtkIdType t : *triangles)
    {
      whole->GetPolys()->GetCellAtId(t, corners);
      for (const vtkIdType corner : *corners)
      {
        isNear[static_cast<std::size_t>(corner)] = true;
      }
    }
    triangles->SetNumberOfIds(numberOfOwn);
    for (vtkIdType t = 0; t < count; ++t)
    {
      whole->GetPolys()->GetCellAtId(t, corners);
      if ((t < first || t >= first + numberOfOwn) &&
        std::any_of(corners->begin(), corners->end(),
          [&isNear](vtkIdType corner) { return isNear[static_cast<std::size_t>(corner)]; }))
      {
        triangles->InsertNextId(t);
      }
    }
  }
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
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("GlobalIds");
  ids->SetNumberOfTuples(whole->GetNumberOfPoints());
  std::iota(ids->GetPointer(0), ids->GetPointer(0) + ids->GetNumberOfTuples(), vtkIdType(0));
  vtkNew<vtkPolyData> numbered;
  numbered->ShallowCopy(whole);
  numbered->GetPointData()->SetGlobalIds(ids);

  const vtkIdType count = whole->GetNumberOfPolys();
  const vtkIdType own = count * (cut.Number + 1) / cut.Count - count * cut.Number / cut.Count;
  const vtkSmartPointer<vtkIdList> triangles = TrianglesOf(whole, cut, own);
  vtkNew<vtkPoints> points;
  points->SetDataType(whole->GetPoints()->GetDataType());
  piece->SetPoints(points);
  piece->AllocateEstimate(triangles->GetNumberOfIds(), 3);
  piece->GetPointData()->CopyAllOn();
  piece->GetPointData()->CopyAllocate(numbered->GetPointData());
  piece->GetCellData()->CopyAllOn();
  piece->GetCellData()->CopyAllocate(numbered->GetCellData());
  piece->CopyCells(numbered, triangles); // points in the order in which triangles have them
  if (cut.Ghosts > 0)
  {
    vtkIdType ownPoints = 0;
    vtkNew<vtkIdList> corners;
    for (vtkIdType t = 0; t < own; ++t)
    {
      piece->GetPolys()->GetCellAtId(t, corners);
      ownPoints = std::max(ownPoints, *std::max_element(corners->begin(), corners->end()) + 1);
    }
    AddGhostTypes(piece->GetPointData(), piece->GetNumberOfPoints(), ownPoints,
      vtkDataSetAttributes::DUPLICATEPOINT);
    AddGhostTypes(
      piece->GetCellData(), piece->GetNumberOfPolys(), own, vtkDataSetAttributes::DUPLICATECELL);
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

/** Makes the points of each id one, in the order of ids. Arrays of points are left out. */
void MergeById(vtkPolyData* joined, vtkDataArray* ids)
{
  std::map<vtkIdType, vtkIdType> placeOf;
  const auto idOf = [ids](vtkIdType p) { return static_cast<vtkIdType>(ids->GetComponent(p, 0)); };
  for (vtkIdType p = 0; p < ids->GetNumberOfTuples(); ++p)
  {
    placeOf.emplace(idOf(p), p);
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(joined->GetPoints()->GetDataType());
  for (auto& place : placeOf)
  {
    place.second = points->InsertNextPoint(joined->GetPoint(place.second));
  }
  for (vtkCellArray* cells :
    { joined->GetVerts(), joined->GetLines(), joined->GetPolys(), joined->GetStrips() })
  {
    vtkDataArray* corners = cells->GetConnectivityArray();
    for (vtkIdType c = 0; c < corners->GetNumberOfTuples(); ++c)
    {
      const auto corner = static_cast<vtkIdType>(corners->GetComponent(c, 0));
      corners->SetComponent(c, 0, static_cast<double>(placeOf[idOf(corner)]));
    }
  }
  joined->GetPointData()->Initialize();
  joined->SetPoints(points);
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
  if (!table)
  {
    return nullptr;
  }
  auto rows = vtkSmartPointer<vtkTable>::New();
  cut.Number == 0 ? rows->ShallowCopy(table)
                  : rows->GetRowData()->CopyStructure(table->GetRowData());
  return rows;
}

vtkSmartPointer<vtkPolyData> OwnPartOf(vtkPolyData* piece)
{
  if (!piece)
  {
    return nullptr;
  }
  auto own = vtkSmartPointer<vtkPolyData>::New();
  own->ShallowCopy(piece);
  if (own->GetCellGhostArray())
  {
    own->RemoveGhostCells();
  }
  return own;
}

vtkSmartPointer<vtkPolyData> JoinSurfaces(const std::vector<vtkSmartPointer<vtkPolyData>>& given)
{
  std::vector<vtkPolyData*> pieces;
  vtkNew<vtkAppendPolyData> append;
  bool haveIds = true;
  for (vtkPolyData* piece : given)
  {
    if (piece && piece->GetNumberOfPoints() > 0 &&
      std::none_of(pieces.begin(), pieces.end(),
        [piece](vtkPolyData* other) { return AreTheSame(piece, other); }))
    {
      pieces.push_back(piece);
      append->AddInputData(piece);
      haveIds = haveIds && piece->GetPointData()->GetGlobalIds();
    }
  }
  if (pieces.size() < 2)
  {
    return pieces.empty() ? vtkSmartPointer<vtkPolyData>::New()
                          : vtkSmartPointer<vtkPolyData>(pieces.front());
  }
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->Update();
  vtkPolyData* joined = append->GetOutput();
  if (joined->GetNumberOfPolys() + joined->GetNumberOfStrips() == 0)
  {
    return joined;
  }
  if (haveIds)
  {
    MergeById(joined, joined->GetPointData()->GetGlobalIds());
    return joined;
  }
  constexpr double tolerance = 1e-6; // Sources that give pieces round the border of each anew.
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(joined);
  clean->SetTolerance(tolerance);
  clean->PieceInvariantOff();
  clean->Update();
  return clean->GetOutput();
}
}

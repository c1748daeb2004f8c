// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/GatherLevels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Host/LargeArray.h"
#include "Host/PrefixErrors.h"
#include "Input/ImagePieces.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace volumic
{
namespace
{
vtkImageData* PieceIn(vtkMultiBlockDataSet* blocks, unsigned int h)
{
  vtkDataObject* block = blocks->GetBlock(h);
  auto* image = vtkImageData::SafeDownCast(block);
  if (block && !image)
  {
    Refuse("block ", h, " is ", block->GetClassName(),
      ", not an image. Give the output of Image Pyramid, or the image itself.");
  }
  return image && image->GetNumberOfPoints() > 0 ? image : nullptr;
}

/** The boxes of cells between the points of the pieces. */
VoxelBox CellsBetween(VoxelBox points)
{
  for (int axis = 0; axis < 3 && !points.IsEmpty(); ++axis)
  {
    points.End[axis] = std::max(points.First[axis] + 1, points.End[axis] - 1);
  }
  return points;
}

vtkSmartPointer<vtkImageData> GatherLevel(Communicator& ranks, vtkImageData* piece,
  vtkInformation* voxels, const std::string& edges)
{
  const ImagePieces pieces(ranks, piece);
  if (pieces.IsEmpty())
  {
    return nullptr;
  }
  const bool isFirst = ranks.Rank() == 0;
  const VoxelBox all = isFirst ? VoxelBox::Of(pieces.Size()) : VoxelBox();
  const auto image = pieces.PartOfFrame(VoxelBox::Of(pieces.Size()));
  image->SetFieldData(pieces.Frame()->GetFieldData());
  const auto gather = [&](vtkDataArray* array, const VoxelPieces& of, const VoxelBox& wanted)
  { return FetchVoxels(ranks, of, array, wanted); };

  vtkPointData* points = piece ? piece->GetPointData() : nullptr;
  const char* ghosts = vtkDataSetAttributes::GhostArrayName();
  const auto chosen = gather(
    piece ? ChooseVoxels(voxels, piece) : nullptr, pieces.Voxels(), all);
  const auto map = edges.empty()
    ? nullptr
    : gather(points ? points->GetArray(edges.c_str()) : nullptr, pieces.Voxels(), all);
  const auto hidden =
    gather(points ? points->GetArray(ghosts) : nullptr, pieces.Voxels(), all);
  const VoxelPieces cells(ranks, CellsBetween(pieces.Voxels().HeldBy(ranks.Rank())));
  const auto hiddenCells = gather(
    piece ? piece->GetCellData()->GetArray(ghosts) : nullptr, cells, CellsBetween(all));
  if (!isFirst)
  {
    return nullptr;
  }
  for (const auto& array : { map, hidden })
  {
    if (array)
    {
      image->GetPointData()->AddArray(array);
    }
  }
  if (hiddenCells)
  {
    image->GetCellData()->AddArray(hiddenCells);
  }
  return WithVoxels(image, chosen);
}

/** Whether points or cells of the image are hidden, on any rank. */
bool HasGhosts(Communicator& ranks, vtkImageData* piece)
{
  const char* ghosts = vtkDataSetAttributes::GhostArrayName();
  return ranks.IsAny(piece &&
    (piece->GetPointData()->GetArray(ghosts) || piece->GetCellData()->GetArray(ghosts)));
}

/** Why a level that all ranks work on is at rank 0 as a whole all the same; empty: it is not. */
std::string WhyWhole(Communicator& ranks, const SegmentationVolume& volume, vtkImageData* piece,
  const std::string& edges)
{
  const SegmentationSettings& settings = volume.Settings;
  vtkDataArray* nans = volume.Levels->GetFieldData()->GetArray("NaNVoxels");
  const std::pair<bool, const char*> reasons[] = {
    { !edges.empty(), "a map of edges is given" },
    { !nans, "the levels do not tell how many voxels are NaN, as those of Image Pyramid do" },
    { nans && nans->GetTuple1(0) != 0.0, "voxels are NaN" },
    { HasGhosts(ranks, piece), "points or cells are hidden" },
    { settings.EdgeLength != 0.0, "Edge Length is set" },
    { settings.SnapshotInterval != 0, "Snapshot Interval is set" },
    { settings.Grading.ThinParts && settings.End.FinestLevel < 0, "Thin Parts is on" },
    { settings.End.FinestLevel < 0, "Finest Level is -1" },
    { settings.End.MemoryLimit != 0, "Memory Limit is set" },
    { !settings.End.ScratchDirectory.empty(), "Scratch Directory is set" },
    { settings.End.Resume, "Resume is set" } };
  const auto* reason = std::find_if(std::begin(reasons), std::end(reasons),
    [](const std::pair<bool, const char*>& each) { return each.first; });
  return reason == std::end(reasons) ? "" : reason->second;
}

/** The level at rank 0, with room for its voxels; what ranks have of them goes to the volume. */
vtkSmartPointer<vtkImageData> LeaveInPieces(
  Communicator& ranks, const ImagePieces& pieces, vtkImageData* piece, int h,
  SegmentationVolume& volume)
{
  LevelInPieces level;
  level.Pieces = pieces.Voxels();
  vtkDataArray* own = piece ? ChooseVoxels(volume.Selection, piece) : nullptr;
  const vtkSmartPointer<vtkDataArray> like = AgreeOnArray(ranks, own);
  level.Values = own ? ContiguousVoxels(own) : nullptr;
  level.Range = RangeOf(ranks, level.Values, ValidVoxels());
  volume.InPieces[h] = level;
  if (ranks.Rank() != 0)
  {
    return nullptr;
  }
  const auto image = pieces.PartOfFrame(VoxelBox::Of(pieces.Size()));
  image->SetFieldData(pieces.Frame()->GetFieldData());
  const ZeroedAllocations zeroed;
  return WithVoxels(image,
    NewLargeArrayLike(
      like, static_cast<vtkIdType>(VoxelBox::Of(pieces.Size()).Count())));
}
}

std::string GatherLevels(Communicator& ranks, SegmentationVolume& volume, vtkInformation* edges)
{
  std::string told;
  if (ranks.NumberOfRanks() == 1)
  {
    return told;
  }
  PrefixErrors("Input port 0: ",
    [&]
    {
      const unsigned int count = volume.Levels->GetNumberOfBlocks();
      const std::vector<unsigned int> counts = GatherValues(ranks, count);
      if (*std::max_element(counts.begin(), counts.end()) !=
        *std::min_element(counts.begin(), counts.end()))
      {
        Refuse("the processes do not have the same number of levels.");
      }
      vtkNew<vtkMultiBlockDataSet> whole;
      whole->SetFieldData(volume.Levels->GetFieldData());
      for (unsigned int h = 0; h < count; ++h)
      {
        const vtkSmartPointer<vtkImageData> level = PrefixErrors(Join("level ", h, ": "),
          [&]
          {
            vtkImageData* piece = PieceIn(volume.Levels, h);
            const ImagePieces pieces(ranks, piece);
            if (h + 1 < count && !pieces.IsEmpty() &&
              SurfaceEvolution::AreShared(volume.Settings.Options, pieces.Size()))
            {
              const std::string why = WhyWhole(ranks, volume, piece, ChosenName(edges));
              if (why.empty())
              {
                return LeaveInPieces(ranks, pieces, piece, static_cast<int>(h), volume);
              }
              if (told.empty())
              {
                told = Join("Level ", h, ", of ", VoxelBox::Of(pieces.Size()).Count(),
                  " voxels, is held by the first process as a whole, as ", why,
                  "; else each process would hold a part of it.");
              }
            }
            return GatherLevel(
              ranks, piece, volume.Selection, ChosenName(edges));
          });
        whole->SetBlock(h, level);
      }
      volume.Levels = whole;
    });
  // Which array it is may have been chosen by its name on other ranks, where this one has none.
  volume.Selection = vtkSmartPointer<vtkInformation>::New();
  volume.Selection->Set(
    vtkDataObject::FIELD_ASSOCIATION(), vtkDataObject::FIELD_ASSOCIATION_POINTS);
  volume.Selection->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
  return told;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/GatherLevels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Common/ScratchMemory.h"
#include "Core/Evolution/SurfaceEvolution.h"
#include "Host/HostThreads.h"
#include "Host/LargeArray.h"
#include "Host/PrefixErrors.h"
#include "Input/ImagePieces.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"
#include "Pyramid/FieldVoxels.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <iterator>
#include <limits>
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

/** Takes a copy in which voxels that are not valid are background. */
void Fill(Communicator& ranks, const ValidVoxels& valid, const SurfaceOptions& options,
  Executor& threads, LevelInPieces& level)
{
  const FieldVoxels read = FieldVoxelsOf(level.Values, level.Range, options.IsoValue);
  const auto filled = NewLargeArray<vtkFloatArray>(valid.Marks.size());
  filled->SetName(level.Values->GetName());
  float* values = filled->GetPointer(0);
  FillInvalid(read, valid.Marks, BackgroundOf(level.Range, options), values, threads);
  level.Values = filled;
  level.Base = read.Base;
  level.Extremes = { std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest() };
  for (std::size_t i = 0; i < valid.Marks.size(); ++i)
  {
    level.Extremes = { std::min(level.Extremes[0], values[i]),
      std::max(level.Extremes[1], values[i]) };
  }
  for (const std::array<float, 2>& other : GatherValues(ranks, level.Extremes))
  {
    level.Extremes = { std::min(level.Extremes[0], other[0]),
      std::max(level.Extremes[1], other[1]) };
  }
}

/** What this rank has of the level, and what all know of it. */
LevelInPieces PiecesOfLevel(Communicator& ranks, const ImagePieces& pieces, vtkImageData* piece,
  int h, const SegmentationVolume& volume)
{
  const SegmentationSettings& settings = volume.Settings;
  LevelInPieces level;
  level.Pieces = pieces.Voxels();
  // Of no voxels where this rank has none: then it is like another one's.
  const vtkSmartPointer<vtkDataArray> voxels =
    AgreeOnArray(ranks, piece ? ChooseVoxels(volume.Selection, piece) : nullptr);
  level.Values = ContiguousVoxels(voxels);
  HostThreads threads(settings.End.NumberOfThreads);
  threads.Run(
    [&]
    {
      const ValidVoxels valid = FindValidVoxels(ranks, pieces, voxels, level.Values, piece,
        settings.NaNIsBackground, threads);
      if (h == 0)
      {
        CheckAnyIsValid(voxels, valid, ranks);
      }
      if (valid.NaNs > 0)
      {
        level.AboutNaNs = DescribeNaNs(voxels, pieces.Frame(), valid);
      }
      level.Range = RangeOf(ranks, level.Values, valid);
      if (settings.End.LeavesCheckpoints())
      {
        level.Hash = HashOfVoxels(ranks, level.Pieces, level.Values, threads);
      }
      if (!valid.AreAll)
      {
        Fill(ranks, valid, settings.Options, threads, level);
      }
    });
  return level;
}

/** By all ranks, where nothing is recovered: at which levels a surface may start. */
void LookForParts(Communicator& ranks, SegmentationVolume& volume)
{
  if (volume.Settings.Recovery != RecoveryType::NoRecovery)
  {
    return;
  }
  // It starts at the first that has one.
  bool isFound = false;
  for (auto level = volume.InPieces.rbegin(); level != volume.InPieces.rend() && !isFound; ++level)
  {
    isFound = level->second.HoldsPart =
      HavePart(ranks, level->second, volume.Settings.Options);
  }
}

/** The level at rank 0, with room for its voxels; what ranks have of them goes to the volume. */
vtkSmartPointer<vtkImageData> LeaveInPieces(Communicator& ranks, const ImagePieces& pieces,
  vtkImageData* piece, int h, SegmentationVolume& volume)
{
  const LevelInPieces& level = volume.InPieces[h] = PiecesOfLevel(ranks, pieces, piece, h, volume);
  if (ranks.Rank() != 0)
  {
    return nullptr;
  }
  const VoxelBox all = VoxelBox::Of(pieces.Size());
  const auto image = pieces.PartOfFrame(all);
  image->SetFieldData(pieces.Frame()->GetFieldData());
  const ZeroedAllocations zeroed;
  return WithVoxels(
    image, NewLargeArrayLike(level.Values, static_cast<vtkIdType>(all.Count())));
}
}

void GatherLevels(Communicator& ranks, SegmentationVolume& volume, vtkInformation* edges)
{
  const SurfaceOptions& options = volume.Settings.Options;
  const std::string map = options.EdgeAttractionWeight > 0.0 ? ChosenName(edges) : "";
  if (ranks.NumberOfRanks() == 1)
  {
    return;
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
            if (h + 1 < count && !pieces.IsEmpty() && map.empty() &&
              SurfaceEvolution::AreShared(options, pieces.Size()))
            {
              return LeaveInPieces(ranks, pieces, piece, static_cast<int>(h), volume);
            }
            return GatherLevel(ranks, piece, volume.Selection, map);
          });
        whole->SetBlock(h, level);
      }
      volume.Levels = whole;
      LookForParts(ranks, volume);
    });
  // Which array it is may have been chosen by its name on other ranks, where this one has none.
  volume.Selection = vtkSmartPointer<vtkInformation>::New();
  volume.Selection->Set(
    vtkDataObject::FIELD_ASSOCIATION(), vtkDataObject::FIELD_ASSOCIATION_POINTS);
  volume.Selection->Set(vtkDataObject::FIELD_ATTRIBUTE_TYPE(), vtkDataSetAttributes::SCALARS);
}
}

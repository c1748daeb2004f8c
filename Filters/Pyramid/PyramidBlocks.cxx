// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/PyramidBlocks.h"

#include "Core/Common/Refuse.h"
#include "Host/HostThreads.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace volumic
{
namespace
{
std::vector<LevelGeometry> Plan(vtkImageData* image, const PyramidOptions& options)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  return PlanPyramid(
    { size[0], size[1], size[2] }, { spacing[0], spacing[1], spacing[2] }, options);
}

void AddLevelFieldData(vtkImageData* image, int level, double unit)
{
  vtkNew<vtkIntArray> levelArray;
  levelArray->SetName("Level");
  levelArray->InsertNextValue(level);
  vtkNew<vtkDoubleArray> unitArray;
  unitArray->SetName("Unit");
  unitArray->InsertNextValue(unit);
  // Not into the input's own field data, which a shallow copy may share.
  vtkNew<vtkFieldData> fieldData;
  fieldData->ShallowCopy(image->GetFieldData());
  fieldData->AddArray(levelArray);
  fieldData->AddArray(unitArray);
  image->SetFieldData(fieldData);
}

/** @param image null where this rank has no piece of the level */
void AddLevel(vtkMultiBlockDataSet* pyramid, std::size_t level, vtkImageData* image, double unit)
{
  if (image)
  {
    AddLevelFieldData(image, static_cast<int>(level), unit);
  }
  const auto block = static_cast<unsigned int>(level);
  pyramid->SetNumberOfBlocks(block + 1);
  pyramid->SetBlock(block, image);
  pyramid->GetMetaData(block)->Set(
    vtkCompositeDataSet::NAME(), ("Level " + std::to_string(level)).c_str());
}

/** A piece of a level: `voxels` are those of the box. */
vtkSmartPointer<vtkImageData> MakeImage(vtkImageData* frame, const char* name,
  vtkDataArray* voxels, const LevelGeometry& geometry, const VoxelBox& box)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(box.First[0], box.End[0] - 1, box.First[1], box.End[1] - 1, box.First[2],
    box.End[2] - 1);
  image->SetSpacing(geometry.Spacing.data());
  image->SetDirectionMatrix(frame->GetDirectionMatrix());
  const int* extent = frame->GetExtent();
  double origin[3];
  frame->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], origin);
  image->SetOrigin(origin);
  voxels->SetName(name);
  image->GetPointData()->SetScalars(voxels);
  return image;
}

/** This rank's piece of a level, with the ghosts that are asked for; null: none. */
vtkSmartPointer<vtkImageData> PieceOfLevel(Communicator& ranks, const PyramidImage& image,
  const LevelVoxels& level, const LevelGeometry& geometry, int ghosts)
{
  const VoxelBox box = level.Pieces.HeldBy(ranks.Rank());
  const char* name = image.Voxels->GetName();
  if (ghosts == 0 || ranks.NumberOfRanks() == 1)
  {
    return box.IsEmpty()
      ? nullptr
      : MakeImage(image.Pieces.Frame(), name, level.Values, geometry, box);
  }
  const std::array<int, 3> size = level.Pieces.Bounds().End;
  const VoxelBox wanted =
    box.IsEmpty() ? box : PieceOf(size, ranks.Rank(), ranks.NumberOfRanks(), ghosts);
  const vtkSmartPointer<vtkDataArray> values =
    FetchVoxels(ranks, level.Pieces, level.Values, wanted);
  if (box.IsEmpty())
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkImageData> piece =
    MakeImage(image.Pieces.Frame(), name, values, geometry, wanted);
  int own[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    own[2 * axis] = box.First[axis];
    own[2 * axis + 1] = box.End[axis] - 1;
  }
  piece->GenerateGhostArray(own);
  return piece;
}

void AddFacts(vtkMultiBlockDataSet* pyramid, bool isComplete, std::int64_t numberOfNaNs)
{
  vtkNew<vtkIdTypeArray> nans;
  nans->SetName("NaNVoxels");
  nans->InsertNextValue(static_cast<vtkIdType>(numberOfNaNs));
  pyramid->GetFieldData()->AddArray(nans);
  vtkNew<vtkStringArray> reason;
  reason->SetName("StopReason");
  reason->InsertNextValue(isComplete ? "complete" : "cancelled");
  pyramid->GetFieldData()->AddArray(reason);
}
}

PyramidImage::PyramidImage(
  Communicator& ranks, vtkImageData* piece, vtkInformation* selection, int component)
  : PyramidImage(ranks, piece,
      piece ? SelectComponent(ChooseArray(selection, piece), component) : nullptr)
{
}

PyramidImage::PyramidImage(
  Communicator& ranks, vtkImageData* piece, const vtkSmartPointer<vtkDataArray>& voxels)
  : Pieces(ranks, piece), Piece(piece), Voxels(AgreeOnArray(ranks, voxels))
{
  if (!this->Voxels)
  {
    Refuse("the image is empty: no process holds any of its voxels.");
  }
}

PyramidBlocks MakePyramidBlocks(
  Communicator& ranks, const PyramidImage& image, const PyramidRequest& request)
{
  vtkImageData* frame = image.Pieces.Frame();
  const std::vector<LevelGeometry> levels = Plan(frame, request.Levels);
  std::vector<LevelVoxels> made;
  ValidVoxels valid;
  HostThreads threads(request.NumberOfThreads);
  threads.Run(
    [&]
    {
      const vtkSmartPointer<vtkDataArray> contiguous = ContiguousVoxels(image.Voxels);
      valid = FindValidVoxels(ranks, image.Pieces, image.Voxels, contiguous, image.Piece,
        request.NaNIsBackground, threads);
      CheckAnyIsValid(image.Voxels, valid, ranks);
      made = MakeLevelVoxels(ranks, image.Pieces.Voxels(), contiguous, valid, levels, threads,
        request.Progress);
    });

  PyramidBlocks pyramid;
  pyramid.Blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  // No voxel is copied, but where one component was selected, which takes the place of the array.
  const vtkSmartPointer<vtkImageData> level0 =
    image.Piece ? WithVoxels(image.Piece, image.Voxels) : nullptr;
  AddLevel(pyramid.Blocks, 0, level0, levels[0].Unit);
  for (std::size_t h = 1; h <= made.size(); ++h)
  {
    AddLevel(pyramid.Blocks, h,
      PieceOfLevel(ranks, image, made[h - 1], levels[h], request.GhostLevels), levels[h].Unit);
  }
  AddFacts(pyramid.Blocks, made.size() + 1 == levels.size(), valid.NaNs);
  if (valid.NaNs > 0)
  {
    pyramid.AboutNaNs = DescribeNaNs(image.Voxels, frame, valid);
  }
  return pyramid;
}

PyramidBlocks StoppedPyramidBlocks()
{
  PyramidBlocks pyramid;
  pyramid.Blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  AddFacts(pyramid.Blocks, false, 0);
  return pyramid;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/PyramidBlocks.h"

#include "Host/Errors.h"
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

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
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

void AddLevel(vtkMultiBlockDataSet* pyramid, std::size_t level, vtkImageData* image, double unit)
{
  AddLevelFieldData(image, static_cast<int>(level), unit);
  const auto block = static_cast<unsigned int>(level);
  pyramid->SetNumberOfBlocks(block + 1);
  pyramid->SetBlock(block, image);
  pyramid->GetMetaData(block)->Set(
    vtkCompositeDataSet::NAME(), ("Level " + std::to_string(level)).c_str());
}

vtkSmartPointer<vtkImageData> MakeImage(
  vtkImageData* frame, const char* name, vtkDataArray* voxels, const LevelGeometry& geometry)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  const LevelSize& size = geometry.Size;
  image->SetDimensions(
    static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2]));
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

PyramidBlocks MakePyramidBlocks(
  vtkImageData* image, vtkDataArray* voxels, const PyramidRequest& request)
{
  const std::vector<LevelGeometry> levels = Plan(image, request.Levels);
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  ValidVoxels valid;
  vtkSmartPointer<vtkDataArray> finest = voxels;
  HostThreads threads(request.NumberOfThreads);
  threads.Run(
    [&]
    {
      vtkSmartPointer<vtkDataArray> contiguous = ContiguousVoxels(voxels);
      if (request.Range.IsUsed())
      {
        finest = contiguous = FoldVoxels(contiguous, request.Range, threads);
      }
      valid = FindValidVoxels(voxels, contiguous, image, request.NaNIsBackground, threads);
      CheckAnyIsValid(voxels, valid);
      made = MakeLevelVoxels(contiguous, valid, levels, threads, request.Progress);
    });

  PyramidBlocks pyramid;
  pyramid.Blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  // No voxel is copied, but where they were folded, or one component was selected: then the new
  // array takes the place of theirs.
  AddLevel(pyramid.Blocks, 0, WithVoxels(image, finest), levels[0].Unit);
  for (std::size_t h = 1; h <= made.size(); ++h)
  {
    AddLevel(pyramid.Blocks, h, MakeImage(image, voxels->GetName(), made[h - 1], levels[h]),
      levels[h].Unit);
  }
  AddFacts(pyramid.Blocks, made.size() + 1 == levels.size(), valid.NaNs);
  if (valid.NaNs > 0)
  {
    pyramid.AboutNaNs = DescribeNaNs(voxels, image, valid);
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

EdgeLengthPlan PlanEdgeLength(
  double edgeLength, double samplingRatio, vtkImageData* image, PyramidOptions& pyramid)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  const EdgeLengthPlan plan = PlanEdgeLength(edgeLength, { size[0], size[1], size[2] },
    { spacing[0], spacing[1], spacing[2] }, EdgeLengthPreferences{ pyramid, samplingRatio });
  pyramid.ReductionFactor = plan.ReductionFactor;
  return plan;
}

vtkSmartPointer<vtkMultiBlockDataSet> BuildPyramid(
  vtkImageData* image, vtkInformation* selection, int component, const PyramidRequest& request)
{
  return PrefixErrors("Input port 0: ",
    [&]
    {
      bool isStopped = false;
      PyramidRequest watched = request;
      watched.Progress = [&](double share, const std::string& text)
      {
        isStopped = isStopped || !request.Progress(share, text);
        return !isStopped;
      };
      const PyramidBlocks made = MakePyramidBlocks(
        image, SelectComponent(ChooseArray(selection, image), component), watched);
      return isStopped ? nullptr : made.Blocks;
    });
}

PyramidOptions LevelsAs(vtkMultiBlockDataSet* blocks)
{
  const auto unit = [blocks](unsigned int h)
  {
    auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    vtkDataArray* array = image ? image->GetFieldData()->GetArray("Unit") : nullptr;
    return array && array->GetNumberOfTuples() == 1 ? array->GetTuple1(0) : 0.0;
  };
  const double factor = blocks->GetNumberOfBlocks() > 1 ? unit(1) / unit(0) : 0.0;
  PyramidOptions levels;
  levels.NumberOfLevels = static_cast<int>(blocks->GetNumberOfBlocks());
  levels.ReductionFactor = factor > 1.0 && factor < 2.0 ? factor : std::sqrt(3.0);
  return levels;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/ImageLevels.h"

#include "Core/Common/Join.h"
#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/LargeArrays.h"
#include "Input/InputImage.h"
#include "Input/ValidVoxels.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace volumic
{
namespace
{
template <typename Real>
using ArrayOf = std::conditional_t<std::is_same_v<Real, float>, vtkFloatArray, vtkDoubleArray>;

/** Return an array of n values. @throws std::runtime_error if memory does not suffice */
template <typename Real>
vtkSmartPointer<ArrayOf<Real>> NewArray(std::int64_t n, int level)
{
  try
  {
    return NewLargeArray<ArrayOf<Real>>(static_cast<std::size_t>(n));
  }
  catch (const std::bad_alloc&)
  {
    throw std::runtime_error(Join("not enough memory for level ", level, " (",
      static_cast<double>(n) * sizeof(Real) / (1024. * 1024.),
      " MB). Set Scratch Directory, reduce Number Of Levels, or crop the image."));
  }
}

/** Return the voxels for level 1. Convert integers to double if float cannot distinguish them. */
vtkSmartPointer<vtkDataArray> SourceVoxels(
  vtkDataArray* contiguous, const ValidVoxels& valid, Executor& executor)
{
  const int type = contiguous->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE || contiguous->GetDataTypeSize() < 4)
  {
    return contiguous;
  }
  const std::array<double, 2> range = RangeOf(contiguous, valid);
  if (FitsFloat(range[0], range[1]))
  {
    return contiguous;
  }
  const auto wide = NewArray<double>(contiguous->GetNumberOfTuples(), 0);
  VisitVoxels(contiguous,
    [&](const auto* values)
    {
      executor.For(static_cast<std::size_t>(wide->GetNumberOfTuples()), 1 << 16,
        [&](std::size_t begin, std::size_t end)
        {
          std::transform(values + begin, values + end, wide->GetPointer(0) + begin,
            [](auto value) { return static_cast<double>(value); });
        });
    });
  return wide;
}

/** Return the fraction of the work before each level, measured in source voxels. */
std::vector<double> FractionBefore(const std::vector<LevelGeometry>& levels)
{
  std::vector<double> fraction(levels.size(), 0.0);
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    fraction[h] = fraction[h - 1] + static_cast<double>(levels[h - 1].NumberOfVoxels());
  }
  const double total = fraction.back();
  for (double& f : fraction)
  {
    f = total > 0.0 ? f / total : 1.0;
  }
  return fraction;
}

/**
 * Compute the voxels of the coarser levels, until `progress` returns false. A voxel is NaN if valid
 * voxels have less than half of the weight in its neighborhood.
 * @param level0 contiguous voxels
 */
template <typename T>
std::vector<vtkSmartPointer<vtkDataArray>> MakeLevelVoxels(const T* level0,
  const LargeVector<std::uint8_t>& valid, const std::vector<LevelGeometry>& levels,
  Executor& executor, const Progress& progress)
{
  using Real = typename RealOf<T>::Type;
  const std::vector<double> before = FractionBefore(levels);
  const auto reduce = [&](std::size_t h, const auto* below, const auto& marks, Real* made)
  {
    const std::string text = Join("Level ", h, " of ", levels.size() - 1);
    const ProgressCallback report = [&](double done)
    { return progress(before[h - 1] + done * (before[h] - before[h - 1]), text); };
    if (!report(0.0))
    {
      return false;
    }
    return marks.empty()
      ? ReduceLevel(below, levels[h - 1], made, levels[h], executor, report)
      : ReduceValidVoxels(below, marks, levels[h - 1], made, levels[h], executor, report);
  };
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  LargeVector<std::uint8_t> marks;
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    const auto array =
      NewArray<Real>(static_cast<std::int64_t>(levels[h].NumberOfVoxels()), static_cast<int>(h));
    Real* values = array->GetPointer(0);
    const bool isFinished = h == 1
      ? reduce(h, level0, valid, values)
      : reduce(h, static_cast<const Real*>(made.back()->GetVoidPointer(0)), marks, values);
    if (!isFinished)
    {
      break;
    }
    if (!valid.empty())
    {
      marks = MarkNumbers(values, array->GetNumberOfTuples());
    }
    made.emplace_back(array);
  }
  return made;
}

std::vector<LevelGeometry> Plan(vtkImageData* image, const PyramidOptions& options)
{
  const int* size = image->GetDimensions();
  const double* spacing = image->GetSpacing();
  return PlanPyramid(
    { size[0], size[1], size[2] }, { spacing[0], spacing[1], spacing[2] }, options);
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
  image->SetOrigin(FirstVoxelOf(frame).data());
  voxels->SetName(name);
  image->GetPointData()->SetScalars(voxels);
  return image;
}

/** Return U_h / U_0 of a block, from its field data `Unit` or else from the spacings. */
double UnitOfBlock(vtkImageData* level0, vtkImageData* image)
{
  const auto storedUnit = [](vtkImageData* block)
  {
    vtkDataArray* unit = block->GetFieldData()->GetArray("Unit");
    return unit && unit->GetNumberOfTuples() == 1 ? std::max(unit->GetTuple1(0), 0.0) : 0.0;
  };
  if (storedUnit(level0) > 0.0 && storedUnit(image) > 0.0)
  {
    return storedUnit(image) / storedUnit(level0);
  }
  double ratio = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    ratio = std::min(ratio, image->GetSpacing()[axis] / level0->GetSpacing()[axis]);
  }
  return ratio;
}
}

PyramidOptions ImageLevels::Options() const
{
  const double factor = this->Levels.size() > 1 ? this->Levels[1].Unit / this->Levels[0].Unit : 0.0;
  PyramidOptions options;
  options.NumberOfLevels = static_cast<int>(this->Levels.size());
  options.ReductionFactor = factor > 1.0 && factor < 2.0 ? factor : std::sqrt(3.0);
  return options;
}

ImageLevels MakeImageLevels(
  vtkImageData* image, vtkDataArray* voxels, const LevelsOptions& options, const Progress& progress)
{
  const std::vector<LevelGeometry> plan = Plan(image, options.Pyramid);
  vtkSmartPointer<vtkDataArray> finest = voxels;
  HostThreads threads(options.NumberOfThreads);
  vtkSmartPointer<vtkDataArray> contiguous = ContiguousVoxels(voxels);
  if (options.Range.IsUsed())
  {
    finest = contiguous = FoldVoxels(contiguous, options.Range, threads);
  }
  const ValidVoxels valid =
    FindValidVoxels(voxels, contiguous, image, options.NaNIsBackground, threads);
  CheckAnyIsValid(voxels, valid);
  const vtkSmartPointer<vtkDataArray> source = SourceVoxels(contiguous, valid, threads);
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  VisitVoxels(source,
    [&](const auto* level0)
    { made = MakeLevelVoxels(level0, valid.Marks, plan, threads, progress); });

  ImageLevels levels;
  // Voxels are copied only by FoldVoxels() and SelectComponent(). The copy replaces the array.
  levels.Levels.push_back({ WithVoxels(image, finest), finest, plan[0].Unit });
  for (std::size_t h = 1; h <= made.size(); ++h)
  {
    levels.Levels.push_back(
      { MakeImage(image, voxels->GetName(), made[h - 1], plan[h]), made[h - 1], plan[h].Unit });
  }
  levels.IsComplete = levels.Levels.size() == plan.size();
  levels.NaNs = valid.NaNs;
  levels.NaNWarning = valid.NaNs > 0 ? DescribeNaNs(voxels, image, valid) : std::string();
  return levels;
}

ImageLevels LevelsOfBlocks(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, bool nanIsBackground)
{
  if (blocks->GetNumberOfBlocks() == 0)
  {
    ThrowInvalidArgument(
      "the input has no blocks, as after an error of Image Pyramid.", LevelsAdvice);
  }
  ImageLevels levels;
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    vtkDataObject* block = blocks->GetBlock(h);
    auto* image = vtkImageData::SafeDownCast(block);
    if (!image)
    {
      ThrowInvalidArgument("block ", h, " is ", block ? block->GetClassName() : "empty",
        ", not an image.", LevelsAdvice);
    }
    const vtkSmartPointer<vtkDataArray> voxels =
      PrefixErrors(Join("level ", h, ": "), [&] { return ChooseVoxels(selection, image); });
    if (h > 0)
    {
      CheckGeometry(levels.Levels[0].Image, levels.Levels.back().Image, image, h);
    }
    levels.Levels.push_back({ image, voxels, 1.0 });
    levels.Levels.back().Unit = UnitOfBlock(levels.Levels[0].Image, image);
  }
  // Image Pyramid has counted and reported them.
  if (!blocks->GetFieldData()->HasArray("NaNVoxels"))
  {
    const ImageLevel& finest = levels.Levels[0];
    Executor thread;
    const ValidVoxels valid = PrefixErrors("level 0: ",
      [&]
      {
        return FindValidVoxels(
          finest.Voxels, ContiguousVoxels(finest.Voxels), finest.Image, nanIsBackground, thread);
      });
    levels.NaNWarning =
      valid.NaNs > 0 ? DescribeNaNs(finest.Voxels, finest.Image, valid) : std::string();
  }
  return levels;
}

ImageLevels LevelsOfArray(const ImageLevels& levels, vtkInformation* selection, int numberOfThreads,
  const Progress& progress)
{
  vtkDataArray* voxels = ChooseVoxels(selection, levels.Levels[0].Image);
  const std::string name = ChosenName(selection);
  const bool isEverywhere = !name.empty() &&
    std::all_of(levels.Levels.begin(), levels.Levels.end(),
      [&name](const ImageLevel& level)
      { return level.Image->GetPointData()->HasArray(name.c_str()); });
  if (!isEverywhere && levels.Levels.size() > 1)
  {
    LevelsOptions options;
    options.Pyramid = levels.Options();
    options.NumberOfThreads = numberOfThreads;
    return MakeImageLevels(levels.Levels[0].Image, voxels, options, progress);
  }
  ImageLevels own = levels;
  for (std::size_t h = 0; h < own.Levels.size(); ++h)
  {
    own.Levels[h].Voxels = PrefixErrors(
      Join("level ", h, ": "), [&] { return ChooseVoxels(selection, own.Levels[h].Image); });
  }
  return own;
}

std::vector<std::string> LevelNames(int numberOfLevels, int finest)
{
  std::vector<std::string> names;
  for (int level = 0; level < numberOfLevels; ++level)
  {
    names.push_back(Join("Level ", level));
  }
  if (finest < 0)
  {
    names.emplace_back("Level -1");
  }
  return names;
}

vtkSmartPointer<vtkMultiBlockDataSet> BlocksOf(const ImageLevels& levels)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (std::size_t h = 0; h < levels.Levels.size(); ++h)
  {
    vtkImageData* image = levels.Levels[h].Image;
    // Do not modify the field data of the input, which a shallow copy may share.
    vtkNew<vtkFieldData> fieldData;
    fieldData->ShallowCopy(image->GetFieldData());
    AddField<vtkIntArray>(fieldData, "Level", static_cast<int>(h));
    AddField<vtkDoubleArray>(fieldData, "Unit", levels.Levels[h].Unit);
    image->SetFieldData(fieldData);
    const auto block = static_cast<unsigned int>(h);
    blocks->SetBlock(block, image);
    blocks->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), Join("Level ", h).c_str());
  }
  AddField<vtkIdTypeArray>(
    blocks->GetFieldData(), "NaNVoxels", static_cast<vtkIdType>(levels.NaNs));
  AddField<vtkStringArray>(
    blocks->GetFieldData(), "StopReason", levels.IsComplete ? "complete" : "cancelled");
  return blocks;
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
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/PyramidBlocks.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "Host/Errors.h"
#include "Host/HostThreads.h"
#include "Host/LimitedMemory.h"
#include "Input/ImageVoxels.h"
#include "Input/ValidVoxels.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
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
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace volumic
{
namespace
{
/** vtkFloatArray or vtkDoubleArray. */
template <typename Real>
using ArrayOf = std::conditional_t<std::is_same_v<Real, float>, vtkFloatArray, vtkDoubleArray>;

/** An array of n values in memory that may turn out not to be had, which is no reason to abort. */
template <typename Real>
vtkSmartPointer<ArrayOf<Real>> NewArray(std::int64_t n, int level)
{
  try
  {
    return NewLargeArray<ArrayOf<Real>>(static_cast<std::size_t>(n));
  }
  catch (const std::bad_alloc&)
  {
    throw std::runtime_error(Join("the memory does not suffice for level ", level, ", which takes ",
      static_cast<double>(n) * sizeof(Real) / (1024. * 1024.),
      " MB. Set Memory Limit, ask for fewer levels, or crop the image."));
  }
}

/**
 * The voxels that level 1 is made of: as double where they are integers that single precision would
 * not keep apart.
 */
vtkSmartPointer<vtkDataArray> SourceVoxels(
  vtkDataArray* contiguous, const ValidVoxels& valid, Executor& executor)
{
  const int type = contiguous->GetDataType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE || contiguous->GetDataTypeSize() < 4)
  {
    return contiguous;
  }
  const std::array<double, 2> range = RangeOf(contiguous, valid);
  if (FloatHolds(range[0], range[1]))
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

/** Input voxels of each level that are looked at: what progress is measured by. */
std::vector<double> ShareDoneBefore(const std::vector<LevelGeometry>& levels)
{
  std::vector<double> share(levels.size(), 0.0);
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    share[h] = share[h - 1] + static_cast<double>(levels[h - 1].NumberOfVoxels());
  }
  const double total = share.back();
  for (double& s : share)
  {
    s = total > 0.0 ? s / total : 1.0;
  }
  return share;
}

/** Makes the levels above level 0, one after the other. */
template <typename T>
class LevelMaker
{
public:
  using Real = typename RealOf<T>::Type;

  LevelMaker(
    const std::vector<LevelGeometry>& levels, Executor& executor, const PyramidProgress& progress)
    : Levels(levels), Threads(executor), Progress(progress), Before(ShareDoneBefore(levels))
  {
  }

  std::vector<vtkSmartPointer<vtkDataArray>> Make(
    const T* level0, const LargeVector<std::uint8_t>& valid)
  {
    std::vector<vtkSmartPointer<vtkDataArray>> made;
    LargeVector<std::uint8_t> marks;
    for (std::size_t h = 1; h < this->Levels.size(); ++h)
    {
      const auto array = NewArray<Real>(
        static_cast<std::int64_t>(this->Levels[h].NumberOfVoxels()), static_cast<int>(h));
      Real* values = array->GetPointer(0);
      const bool isFinished = h == 1
        ? this->Reduce(h, level0, valid, values)
        : this->Reduce(h, static_cast<const Real*>(made.back()->GetVoidPointer(0)), marks, values);
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

private:
  /** Level h from the one below it. */
  template <typename Below>
  bool Reduce(std::size_t h, const Below* below, const LargeVector<std::uint8_t>& marks, Real* made)
  {
    const std::string text = Join("Level ", h, " of ", this->Levels.size() - 1);
    const double before = this->Before[h - 1];
    const double share = this->Before[h] - before;
    const LevelProgress progress = [&](double done)
    { return this->Progress(before + done * share, text); };
    if (!progress(0.0))
    {
      return false;
    }
    const LevelGeometry& geometry = this->Levels[h - 1];
    return marks.empty()
      ? ReduceLevel(below, geometry, made, this->Levels[h], this->Threads, progress)
      : ReduceValidVoxels(below, marks, geometry, made, this->Levels[h], this->Threads, progress);
  }

  const std::vector<LevelGeometry>& Levels;
  Executor& Threads;
  const PyramidProgress& Progress;
  std::vector<double> Before;
};
/**
 * The voxels of the levels above level 0, as far as they were finished before `progress` said stop.
 * Where not all voxels of level 0 are valid, those of the other levels are NaN whose neighbourhood
 * has more voxels without a value than with one.
 * @param voxels of level 0, contiguous in memory (ContiguousVoxels)
 */
std::vector<vtkSmartPointer<vtkDataArray>> MakeLevelVoxels(vtkDataArray* voxels,
  const ValidVoxels& valid, const std::vector<LevelGeometry>& levels, Executor& executor,
  const PyramidProgress& progress)
{
  const vtkSmartPointer<vtkDataArray> source = SourceVoxels(voxels, valid, executor);
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  VisitVoxels(source,
    [&](const auto* level0)
    {
      using Voxel = std::remove_cv_t<std::remove_pointer_t<decltype(level0)>>;
      made = LevelMaker<Voxel>(levels, executor, progress).Make(level0, valid.Marks);
    });
  return made;
}

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
  vtkSmartPointer<vtkDataArray> finest = voxels;
  HostThreads threads(request.NumberOfThreads);
  vtkSmartPointer<vtkDataArray> contiguous = ContiguousVoxels(voxels);
  if (request.Range.IsUsed())
  {
    finest = contiguous = FoldVoxels(contiguous, request.Range, threads);
  }
  const ValidVoxels valid =
    FindValidVoxels(voxels, contiguous, image, request.NaNIsBackground, threads);
  CheckAnyIsValid(voxels, valid);
  const std::vector<vtkSmartPointer<vtkDataArray>> made =
    MakeLevelVoxels(contiguous, valid, levels, threads, request.Progress);

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

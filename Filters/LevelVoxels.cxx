// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "ImageVoxels.h"
#include "LargeArray.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <type_traits>

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
    throw std::runtime_error(Join("the memory does not suffice for level ", level,
      ", which takes ", static_cast<double>(n) * sizeof(Real) / (1024. * 1024.),
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
  const auto copy = [&](const auto* values)
  {
    executor.For(static_cast<std::size_t>(wide->GetNumberOfTuples()), 1 << 16,
      [&](std::size_t begin, std::size_t end)
      {
        std::transform(values + begin, values + end, wide->GetPointer(0) + begin,
          [](auto value) { return static_cast<double>(value); });
      });
  };
  switch (type)
  {
    vtkTemplateMacro(copy(static_cast<const VTK_TT*>(contiguous->GetVoidPointer(0))));
  }
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

/**
 * Level h + 1 from level h, where voxels without a value are known by their marks (none: all have).
 */
template <typename T>
bool Reduce(const T* below, const std::vector<std::uint8_t>& marks, const LevelGeometry& geometry,
  typename RealOf<T>::Type* made, const LevelGeometry& above, Executor& executor,
  const LevelProgress& progress)
{
  return marks.empty()
    ? ReduceLevel(below, geometry, made, above, executor, progress)
    : ReduceValidVoxels(below, marks, geometry, made, above, executor, progress);
}

template <typename T>
std::vector<vtkSmartPointer<vtkDataArray>> MakeLevels(const T* level0,
  const std::vector<std::uint8_t>& valid, const std::vector<LevelGeometry>& levels,
  Executor& executor, const PyramidProgress& progress)
{
  using Real = typename RealOf<T>::Type;
  const std::vector<double> before = ShareDoneBefore(levels);
  std::vector<vtkSmartPointer<vtkDataArray>> made;
  const Real* below = nullptr;
  std::vector<std::uint8_t> marks;
  for (std::size_t h = 1; h < levels.size(); ++h)
  {
    const auto array = NewArray<Real>(levels[h].NumberOfVoxels(), static_cast<int>(h));
    Real* values = array->GetPointer(0);
    const std::string text = Join("Level ", h, " of ", levels.size() - 1);
    const auto levelProgress = [&](double share)
    { return progress(before[h - 1] + share * (before[h] - before[h - 1]), text); };
    const bool isFinished = levelProgress(0.0) &&
      (h == 1 ? Reduce(level0, valid, levels[0], values, levels[1], executor, levelProgress)
              : Reduce(below, marks, levels[h - 1], values, levels[h], executor, levelProgress));
    if (!isFinished)
    {
      break;
    }
    if (!valid.empty())
    {
      marks = MarkNumbers(values, levels[h].NumberOfVoxels());
    }
    below = values;
    made.emplace_back(array);
  }
  return made;
}
}

std::vector<vtkSmartPointer<vtkDataArray>> MakeLevelVoxels(vtkDataArray* voxels,
  const ValidVoxels& valid, const std::vector<LevelGeometry>& levels, Executor& executor,
  const PyramidProgress& progress)
{
  const vtkSmartPointer<vtkDataArray> source = SourceVoxels(voxels, valid, executor);
  switch (source->GetDataType())
  {
    vtkTemplateMacro(return MakeLevels(static_cast<const VTK_TT*>(source->GetVoidPointer(0)),
      valid.Marks, levels, executor, progress));
    default:
      Refuse(NameOf(voxels), " has voxels of type ", voxels->GetDataTypeAsString(),
        ", which is not supported.");
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/LevelVoxels.h"

#include "Core/Common/Join.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/LevelReduction.h"
#include "Core/Image/ValidReduction.h"
#include "Host/LimitedMemory.h"
#include "Input/ImageVoxels.h"

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
}

std::vector<vtkSmartPointer<vtkDataArray>> MakeLevelVoxels(vtkDataArray* voxels,
  const ValidVoxels& valid, const std::vector<LevelGeometry>& levels, Executor& executor,
  const PyramidProgress& progress)
{
  const vtkSmartPointer<vtkDataArray> source = SourceVoxels(voxels, valid, executor);
  const auto make = [&](const auto* level0)
  {
    using Voxel = std::remove_cv_t<std::remove_pointer_t<decltype(level0)>>;
    return LevelMaker<Voxel>(levels, executor, progress).Make(level0, valid.Marks);
  };
  switch (source->GetDataType())
  {
    vtkTemplateMacro(return make(static_cast<const VTK_TT*>(source->GetVoidPointer(0))));
    default:
      Refuse(NameOf(voxels), " has voxels of type ", voxels->GetDataTypeAsString(),
        ", which is not supported.");
  }
}
}

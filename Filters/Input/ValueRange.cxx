// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/ValueRange.h"

#include "Core/Common/Refuse.h"
#include "Host/LargeArray.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volumic
{
namespace
{
/** Voxels under which a thread is not worth it. */
constexpr std::size_t FoldGrain = 1 << 16;

template <typename Array, typename T>
vtkSmartPointer<vtkDataArray> Fold(
  const T* voxels, std::size_t count, const ValueRange& range, Executor& threads)
{
  const auto folded = NewLargeArray<Array>(count);
  auto* to = folded->GetPointer(0);
  const double sum = range.Lower + range.Upper;
  threads.For(count, FoldGrain,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto value = static_cast<double>(voxels[i]);
        // In this order NaN stays NaN, and an infinite voxel infinite.
        to[i] = static_cast<typename Array::ValueType>(std::min(value, sum - value));
      }
    });
  return folded;
}
}

void ValueRange::Check() const
{
  if (!this->IsUsed())
  {
    return;
  }
  if (!std::isfinite(this->Upper))
  {
    Refuse("Upper Value is ", this->Upper,
      "; it must be a number above Iso Value, or infinite, where the object has all values above "
      "that.");
  }
  if (!std::isfinite(this->Lower))
  {
    Refuse("Upper Value is ", this->Upper, ", but Iso Value is ",
      std::isnan(this->Lower) ? std::string("not set") : Join(this->Lower),
      "; set it to the least value of the object. For all that is below a value set Iso Value to "
      "that and switch Object Is Bright off.");
  }
  if (!(this->Lower < this->Upper))
  {
    Refuse("Upper Value is ", this->Upper, ", but Iso Value is ", this->Lower,
      "; it must be more: the object has the values between the two.");
  }
}

vtkSmartPointer<vtkDataArray> FoldVoxels(
  vtkDataArray* voxels, const ValueRange& range, Executor& threads)
{
  const auto count = static_cast<std::size_t>(voxels->GetNumberOfTuples());
  const bool isSmall = voxels->GetDataType() == VTK_FLOAT || voxels->GetDataTypeSize() < 4;
  vtkSmartPointer<vtkDataArray> folded;
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro({
      const auto* values = static_cast<const VTK_TT*>(voxels->GetVoidPointer(0));
      folded = isSmall ? Fold<vtkFloatArray>(values, count, range, threads)
                       : Fold<vtkDoubleArray>(values, count, range, threads);
    });
    default:
      Refuse(NameOf(voxels), " has voxels of type ", voxels->GetDataTypeAsString(),
        ", which is not supported.");
  }
  folded->SetName(voxels->GetName());
  return folded;
}
}

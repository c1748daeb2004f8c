// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/FieldVoxels.h"

#include "Core/Common/ContentHash.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelHash.h"
#include "Input/ImageVoxels.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>

#include <algorithm>
#include <cstddef>

namespace volumic
{
FieldVoxels FieldVoxelsOf(vtkDataArray* voxels, const std::array<double, 2>& range, double base)
{
  FieldVoxels read;
  if (voxels->GetDataType() == VTK_FLOAT && FloatHolds(range[0], range[1]))
  {
    read.Values = static_cast<const float*>(voxels->GetVoidPointer(0));
    return read;
  }
  read.Base = base;
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(
      read.Values = VoxelValues(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)), base));
    default:
      Refuse(NameOf(voxels), " has voxels of type ", voxels->GetDataTypeAsString(),
        ", which is not supported.");
  }
  return read;
}

double BackgroundOf(const std::array<double, 2>& range, const SurfaceOptions& options)
{
  const double iso = options.IsoValue;
  const double away = std::max(range[1] - iso, iso - range[0]);
  return options.ObjectIsBright ? iso - away : iso + away;
}

std::uint64_t HashOfVoxels(
  vtkDataArray* voxels, const std::array<int, 3>& size, Executor& executor)
{
  const VoxelBox all = VoxelBox::Of(size);
  return CombineHashes(static_cast<std::uint64_t>(voxels->GetDataType()),
    HashOfVoxels(voxels->GetVoidPointer(0), static_cast<std::size_t>(voxels->GetDataTypeSize()), all,
      all, all, executor));
}

bool HavePart(vtkDataArray* voxels, const std::array<int, 3>& size, const ValidVoxels& valid,
  const PartSize& least, double isoValue, bool objectIsBright)
{
  const auto have = [&](const auto* values)
  {
    return HasThickPart(
      [&](std::int64_t voxel)
      {
        const auto number = static_cast<double>(values[voxel]);
        return (objectIsBright ? number > isoValue : number < isoValue) && valid.Has(voxel);
      },
      size, least);
  };
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(return have(static_cast<const VTK_TT*>(voxels->GetVoidPointer(0))));
    default:
      return true;
  }
}

void FillInvalid(const FieldVoxels& voxels, const LargeVector<std::uint8_t>& marks,
  double background, float* filled, Executor& executor)
{
  const auto value = static_cast<float>(background - voxels.Base);
  executor.For(marks.size(), 1 << 16,
    [&](std::size_t begin, std::size_t end)
    {
      voxels.Values.Copy(static_cast<std::ptrdiff_t>(begin),
        static_cast<std::ptrdiff_t>(end - begin), filled + begin);
      for (std::size_t i = begin; i < end; ++i)
      {
        filled[i] = marks[i] != 0 ? filled[i] : value;
      }
    });
}
}

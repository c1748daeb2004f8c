// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/PyramidLevels.h"

#include "Core/Common/ThrowInvalidArgument.h"
#include "Core/Image/VoxelNumbers.h"
#include "Host/Errors.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
void CheckSize(vtkImageData* image, const std::string& name, const char* advice)
{
  const int* size = image->GetDimensions();
  if (*std::min_element(size, size + 3) == 1)
  {
    ThrowInvalidArgument(name, " is 2D (", SizeOf(image),
      " voxels). Connect an image with at least ", PyramidLevels::MinimumSize,
      " voxels along each axis.");
  }
  if (*std::min_element(size, size + 3) < PyramidLevels::MinimumSize)
  {
    ThrowInvalidArgument(name, " has ", SizeOf(image), " voxels; it must have at least ",
      PyramidLevels::MinimumSize, " along each axis. ", advice);
  }
}

/** Set the values of an image. `base` is subtracted, except from floats with enough resolution. */
void ShareVoxels(
  LevelImage& to, vtkDataArray* voxels, const std::array<double, 2>& range, double base)
{
  if (voxels->GetDataType() == VTK_FLOAT && FitsFloat(range[0], range[1]))
  {
    to.Values = static_cast<const float*>(voxels->GetVoidPointer(0));
    return;
  }
  to.Base = base;
  VisitVoxels(voxels, [&](const auto* values) { to.Values = VoxelValues(values, base); });
}

/** Copy the values to `filled`. Set invalid ones to the background. */
void FillInvalid(const LevelImage& image, const LargeVector<std::uint8_t>& marks, double background,
  float* filled, Executor& executor)
{
  const auto value = static_cast<float>(background - image.Base);
  executor.For(marks.size(), 1 << 16,
    [&](std::size_t begin, std::size_t end)
    {
      image.Values.Copy(static_cast<std::ptrdiff_t>(begin),
        static_cast<std::ptrdiff_t>(end - begin), filled + begin);
      for (std::size_t i = begin; i < end; ++i)
      {
        filled[i] = marks[i] != 0 ? filled[i] : value;
      }
    });
}
}

PyramidLevels::PyramidLevels(const ImageLevels& levels, Metric metric, bool nanIsBackground)
  : Levels(levels.Levels), FactorBelow(levels.FactorBelow), NaNIsBackground(nanIsBackground)
{
  CheckSize(this->Levels[0].Image, "the image",
    "Resample it more finely (vtkImageResize; ParaView: Resample To Image).");
  this->Space = ComputationalSpace(this->Levels[0].Image, metric);
  for (const ImageLevel& level : this->Levels)
  {
    const int* size = level.Image->GetDimensions();
    this->Sizes.push_back({ size[0], size[1], size[2] });
  }
}

ValidVoxels PyramidLevels::ValidAt(int level, Executor& executor) const
{
  return PrefixErrors(Join("level ", level, ": "),
    [&]
    {
      const ImageLevel& at = this->Levels[level];
      return FindValidVoxels(
        at.Voxels, ContiguousVoxels(at.Voxels), at.Image, this->NaNIsBackground, executor);
    });
}

bool PyramidLevels::HasRoom(int level) const
{
  const std::array<int, 3>& size = this->Sizes[level];
  return *std::min_element(size.begin(), size.end()) >= MinimumSize;
}

std::int64_t PyramidLevels::NumberOfVoxels(int level) const
{
  return VoxelNumbers(this->Sizes[level]).Count();
}

double PyramidLevels::UnitOf(int level) const
{
  return level < 0 ? 1.0 / this->FactorBelow : this->Levels[level].Unit / this->Levels[0].Unit;
}

bool PyramidLevels::ContainsPart(
  int level, const PartSize& least, double isoValue, bool objectIsBright) const
{
  Executor thread;
  const ValidVoxels valid = this->ValidAt(level, thread);
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Levels[level].Voxels);
  bool contains = false;
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      contains = HasThickPart(
        [&](std::int64_t voxel)
        {
          const auto number = static_cast<double>(values[voxel]);
          return (objectIsBright ? number > isoValue : number < isoValue) && valid.Has(voxel);
        },
        this->Sizes[level], least);
    });
  return contains;
}

std::array<double, 2> PyramidLevels::Range(int level) const
{
  const auto found = this->Ranges.find(level);
  if (found != this->Ranges.end())
  {
    return found->second;
  }
  Executor thread;
  const ValidVoxels valid = this->ValidAt(level, thread);
  if (level == 0)
  {
    CheckAnyIsValid(this->Levels[0].Voxels, valid);
  }
  return this->Ranges[level] = RangeOf(ContiguousVoxels(this->Levels[level].Voxels), valid);
}

LevelImage PyramidLevels::Load(int requested, double base, double background, Executor& executor)
{
  const int level = std::max(requested, 0);
  const std::string name = Join("level ", level);
  CheckSize(this->Levels[level].Image, name, "Set Coarsest Level to a finer level.");
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Levels[level].Voxels);
  const ValidVoxels valid = this->ValidAt(level, executor);
  // Sums and differences of voxels must not overflow.
  constexpr double largest = 1e37;
  const std::array<double, 2> range = this->Range(level);
  const double size = std::max(std::abs(range[0]), std::abs(range[1]));
  if (size > largest)
  {
    ThrowInvalidArgument(name, ": ", NameOf(this->Levels[level].Voxels), " has absolute values of ",
      size, ", more than ", largest, ", the limit of single precision. Scale the image.");
  }

  this->Loaded = voxels;
  this->Filled = LargeVector<float>();
  LevelImage loaded;
  ShareVoxels(loaded, voxels, range, base);
  if (!valid.Marks.empty())
  {
    this->Filled.resize(valid.Marks.size());
    FillInvalid(loaded, valid.Marks, background, this->Filled.data(), executor);
    loaded.Values = this->Filled.data();
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    loaded.Size[axis] = this->Sizes[level][axis];
    loaded.Step[axis] =
      this->Space.Step()[axis] * static_cast<double>(this->Sizes[0][axis]) / loaded.Size[axis];
  }
  loaded.Unit = this->UnitOf(requested);
  return loaded;
}

void PyramidLevels::ReleaseCoarserThan(int level)
{
  this->Loaded = nullptr;
  this->Filled = LargeVector<float>();
  for (int h = level == AllLevels ? 0 : std::max(level, 0) + 1; h < this->NumberOfLevels(); ++h)
  {
    this->Levels[h].Image = nullptr;
    this->Levels[h].Voxels = nullptr;
  }
}
}

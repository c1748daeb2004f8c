// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/PyramidLevels.h"

#include "Core/Common/ContentHash.h"
#include "Core/Common/Refuse.h"
#include "Core/Image/VoxelHash.h"
#include "Core/Image/VoxelNumbers.h"
#include "Host/Errors.h"
#include "Input/ImageVoxels.h"
#include "Input/InputImage.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace volumic
{
namespace
{
void CheckSize(vtkImageData* image, const std::string& what, const char* wayOut)
{
  const int* size = image->GetDimensions();
  if (*std::min_element(size, size + 3) == 1)
  {
    Refuse(what, " is 2D (", SizeOf(image), " voxels); a surface needs a volume.");
  }
  if (*std::min_element(size, size + 3) < PyramidLevels::MinimumSize)
  {
    Refuse(what, " has ", SizeOf(image), " voxels; at least ", PyramidLevels::MinimumSize,
      " are needed along each axis. ", wayOut);
  }
}

/** U_h / U_0: what the pyramid wrote down, or else what the spacings tell. */
double UnitInWorkspace(vtkImageData* level0, vtkImageData* image)
{
  vtkDataArray* unit0 = level0->GetFieldData()->GetArray("Unit");
  vtkDataArray* unit = image->GetFieldData()->GetArray("Unit");
  if (unit0 && unit && unit0->GetNumberOfTuples() == 1 && unit->GetNumberOfTuples() == 1 &&
    unit0->GetTuple1(0) > 0 && unit->GetTuple1(0) > 0)
  {
    return unit->GetTuple1(0) / unit0->GetTuple1(0);
  }
  double ratio = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double step = image->GetSpacing()[axis] / level0->GetSpacing()[axis];
    ratio = axis == 0 ? step : std::min(ratio, step);
  }
  return ratio;
}

/**
 * The voxels as the surface reads them. Floats are taken as they are, unless their differences are
 * small beside their size; of all others `base` is subtracted.
 */
void ShareVoxels(
  LevelImage& to, vtkDataArray* voxels, const std::array<double, 2>& range, double base)
{
  if (voxels->GetDataType() == VTK_FLOAT && FloatHolds(range[0], range[1]))
  {
    to.Values = static_cast<const float*>(voxels->GetVoidPointer(0));
    return;
  }
  to.Base = base;
  VisitVoxels(voxels, [&](const auto* values) { to.Values = VoxelValues(values, base); });
}

/** Copies the values to `filled`, with the background for those that are not marked as valid. */
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

PyramidLevels::PyramidLevels(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, Metric metric, bool nanIsBackground)
  : NaNIsBackground(nanIsBackground)
{
  if (blocks->GetNumberOfBlocks() == 0)
  {
    Refuse("there is no level: the input has no blocks, as after an error of Image Pyramid.",
      LevelsWayOut);
  }
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    vtkDataObject* block = blocks->GetBlock(h);
    auto* image = vtkImageData::SafeDownCast(block);
    if (!image)
    {
      Refuse("block ", h, " is ", block ? block->GetClassName() : "empty", ", not an image.",
        LevelsWayOut);
    }
    this->Voxels.emplace_back(
      PrefixErrors(Join("level ", h, ": "), [&] { return ChooseVoxels(selection, image); }));
    if (h == 0)
    {
      CheckSize(image, "the image",
        "Resample it more finely (vtkImageResize; ParaView: Resample To Image).");
      this->Space = Workspace(image, metric);
    }
    else
    {
      CheckPlace(this->Images[0], this->Images.back(), image, h);
    }
    this->Images.emplace_back(image);
    const int* size = image->GetDimensions();
    this->Sizes.push_back({ size[0], size[1], size[2] });
    this->Units.push_back(UnitInWorkspace(this->Images[0], image));
  }
  this->Ranges.resize(this->Images.size());
}

PyramidLevels::~PyramidLevels() = default;
PyramidLevels::PyramidLevels(PyramidLevels&&) noexcept = default;

ValidVoxels PyramidLevels::ValidAt(int level, Executor& executor) const
{
  return PrefixErrors(Join("level ", level, ": "),
    [&]
    {
      return FindValidVoxels(this->Voxels[level], ContiguousVoxels(this->Voxels[level]),
        this->Images[level], this->NaNIsBackground, executor);
    });
}

bool PyramidLevels::HasRoom(int level) const
{
  const Size& size = this->Sizes[level];
  return *std::min_element(size.begin(), size.end()) >= MinimumSize;
}

std::int64_t PyramidLevels::NumberOfVoxels(int level) const
{
  return VoxelNumbers(this->Sizes[level]).Count();
}

std::array<int, 3> PyramidLevels::SizeOfLevel0() const
{
  return this->Sizes[0];
}

double PyramidLevels::UnitInWorld(int level) const
{
  return this->UnitOf(level) * this->Space.WorldUnit();
}

double PyramidLevels::UnitOf(int level) const
{
  return level < 0 ? this->Units[0] / this->FactorBelowLevel0 : this->Units[level];
}

bool PyramidLevels::HoldsPart(
  int level, const PartSize& least, double isoValue, bool objectIsBright) const
{
  Executor thread;
  const ValidVoxels valid = this->ValidAt(level, thread);
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Voxels[level]);
  bool holds = false;
  VisitVoxels(voxels,
    [&](const auto* values)
    {
      holds = HasThickPart(
        [&](std::int64_t voxel)
        {
          const auto number = static_cast<double>(values[voxel]);
          return (objectIsBright ? number > isoValue : number < isoValue) && valid.Has(voxel);
        },
        this->Sizes[level], least);
    });
  return holds;
}

std::array<double, 2> PyramidLevels::Range(int level) const
{
  std::optional<std::array<double, 2>>& range = this->Ranges[level];
  if (!range)
  {
    Executor thread;
    const ValidVoxels valid = this->ValidAt(level, thread);
    if (level == 0)
    {
      CheckAnyIsValid(this->Voxels[0], valid);
    }
    range = RangeOf(ContiguousVoxels(this->Voxels[level]), valid);
  }
  return *range;
}

std::string PyramidLevels::DescribeNaNsOfLevel0() const
{
  Executor thread;
  const ValidVoxels valid = this->ValidAt(0, thread);
  return valid.NaNs > 0 ? DescribeNaNs(this->Voxels[0], this->Images[0], valid) : std::string();
}

std::uint64_t PyramidLevels::HashOfVoxels(int level, Executor& executor) const
{
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Voxels[level]);
  const VoxelBox all = VoxelBox::Of(this->Sizes[level]);
  return CombineHashes(static_cast<std::uint64_t>(voxels->GetDataType()),
    volumic::HashOfVoxels(voxels->GetVoidPointer(0),
      static_cast<std::size_t>(voxels->GetDataTypeSize()), all, all, all, executor));
}

LevelImage PyramidLevels::Load(int wanted, double base, double background, Executor& executor)
{
  const int level = std::max(wanted, 0);
  vtkImageData* image = this->Images[level];
  const std::string name = "level " + std::to_string(level);
  CheckSize(image, name, "Set Coarsest Level to a finer level.");
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Voxels[level]);
  const ValidVoxels valid = this->ValidAt(level, executor);
  // Sums and differences of voxels must not overflow either.
  constexpr double largest = 1e37;
  const std::array<double, 2> range = this->Range(level);
  const double size = std::max(std::abs(range[0]), std::abs(range[1]));
  if (size > largest)
  {
    Refuse(name, ": ", NameOf(this->Voxels[level]), " has values of ", size, " in size; at most ",
      largest, " can be used, since the surface computes in single precision. Scale the image.");
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
  loaded.Unit = this->UnitOf(wanted);
  return loaded;
}

void PyramidLevels::ReleaseCoarserThan(int level)
{
  this->Loaded = nullptr;
  this->Filled = LargeVector<float>();
  for (int h = level == AllLevels ? 0 : std::max(level, 0) + 1; h < this->NumberOfLevels(); ++h)
  {
    this->Images[h] = nullptr;
    this->Voxels[h] = nullptr;
  }
}
}

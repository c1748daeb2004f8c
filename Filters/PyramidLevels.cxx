// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PyramidLevels.h"

#include "Core/Refuse.h"
#include "Core/ThickPart.h"
#include "ImageVoxels.h"
#include "NotFiniteVoxels.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiBlockDataSet.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace volumic
{
namespace
{
constexpr const char* WayOut = " Give the output of Image Pyramid, or the image itself.";

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

/// All levels have the place of the first voxel, the direction and the real size of level 0.
void CheckPlace(vtkImageData* level0, vtkImageData* image, unsigned int h)
{
  const int* extent0 = level0->GetExtent();
  const int* extent = image->GetExtent();
  double first0[3];
  double first[3];
  level0->TransformIndexToPhysicalPoint(extent0[0], extent0[2], extent0[4], first0);
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], first);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double real0 = level0->GetSpacing()[axis] * level0->GetDimensions()[axis];
    const double real = image->GetSpacing()[axis] * image->GetDimensions()[axis];
    const double tolerance = 1e-5 * std::abs(real0);
    if (std::abs(real - real0) > tolerance)
    {
      Refuse("block ", h, " is not a level of a pyramid: its real size along ", "xyz"[axis], " is ",
        real, ", that of block 0 is ", real0, ".", WayOut);
    }
    if (std::abs(first[axis] - first0[axis]) > tolerance)
    {
      Refuse("block ", h, " is not a level of a pyramid: its first voxel lies at ", first[axis],
        " along ", "xyz"[axis], ", that of block 0 at ", first0[axis], ".", WayOut);
    }
  }
  for (int i = 0; i < 9; ++i)
  {
    const double difference =
      image->GetDirectionMatrix()->GetData()[i] - level0->GetDirectionMatrix()->GetData()[i];
    if (std::abs(difference) > 1e-6)
    {
      Refuse(
        "block ", h, " is not a level of a pyramid: its direction differs from block 0's.", WayOut);
    }
  }
}

void CheckShrinks(vtkImageData* below, vtkImageData* image, unsigned int h)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    // An axis of one voxel stays one while others shrink.
    const bool isDone = below->GetDimensions()[axis] == 1 && image->GetDimensions()[axis] == 1;
    if (!isDone && image->GetDimensions()[axis] >= below->GetDimensions()[axis])
    {
      Refuse("block ", h, " is not a level of a pyramid: it has ", SizeOf(image),
        " voxels, and block ", h - 1, " below it ", SizeOf(below), ".", WayOut);
    }
  }
}

/// U_h / U_0: what the pyramid wrote down, or else what the spacings tell.
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

template <typename T>
void Convert(const T* values, double base, std::vector<float>& converted, Executor& executor)
{
  executor.For(converted.size(), 1 << 16,
    [&](std::size_t begin, std::size_t end)
    {
      std::transform(values + begin, values + end, converted.begin() + begin,
        [base](T value) { return static_cast<float>(static_cast<double>(value) - base); });
    });
}

template <typename T>
void MarkObject(
  const T* values, double isoValue, bool objectIsBright, std::vector<std::uint8_t>& marks)
{
  std::transform(values, values + marks.size(), marks.begin(),
    [=](T value)
    {
      const auto number = static_cast<double>(value);
      return static_cast<std::uint8_t>(objectIsBright ? number > isoValue : number < isoValue);
    });
}
}

PyramidLevels::PyramidLevels(
  vtkMultiBlockDataSet* blocks, vtkInformation* selection, Metric metric)
{
  if (blocks->GetNumberOfBlocks() == 0)
  {
    Refuse("there is no level: the input has no blocks, as after an error of Image Pyramid.", WayOut);
  }
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    vtkDataObject* block = blocks->GetBlock(h);
    auto* image = vtkImageData::SafeDownCast(block);
    if (!image)
    {
      Refuse(
        "block ", h, " is ", block ? block->GetClassName() : "empty", ", not an image.", WayOut);
    }
    try
    {
      this->Voxels.emplace_back(ChooseVoxels(selection, image));
    }
    catch (const std::invalid_argument& error)
    {
      Refuse("level ", h, ": ", error.what());
    }
    if (h == 0)
    {
      CheckSize(image, "the image", "Resample it more finely.");
      this->Space = Workspace(image, metric);
    }
    else
    {
      CheckPlace(this->Images[0], image, h);
      CheckShrinks(this->Images.back(), image, h);
    }
    this->Images.push_back(image);
    this->Units.push_back(UnitInWorkspace(this->Images[0], image));
  }
}

bool PyramidLevels::HasRoom(int level) const
{
  const int* size = this->Images[level]->GetDimensions();
  return *std::min_element(size, size + 3) >= MinimumSize;
}

std::int64_t PyramidLevels::NumberOfVoxels(int level) const
{
  return this->Images[level]->GetNumberOfPoints();
}

std::array<int, 3> PyramidLevels::SizeOfLevel0() const
{
  const int* size = this->Images[0]->GetDimensions();
  return { size[0], size[1], size[2] };
}

double PyramidLevels::UnitInWorld(int level) const
{
  return this->UnitOf(level) * this->Space.WorldUnit();
}

double PyramidLevels::UnitOf(int level) const
{
  return level < 0 ? this->Units[0] / this->FactorBelowLevel0 : this->Units[level];
}

bool PyramidLevels::HoldsObject(int level, double isoValue, bool objectIsBright) const
{
  vtkImageData* image = this->Images[level];
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Voxels[level]);
  std::vector<std::uint8_t> marks(static_cast<std::size_t>(image->GetNumberOfPoints()));
  switch (voxels->GetDataType())
  {
    vtkTemplateMacro(MarkObject(
      static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)), isoValue, objectIsBright, marks));
    default:
      return true; // Load() will say what is wrong.
  }
  const int* size = image->GetDimensions();
  return HasThickPart(marks, { size[0], size[1], size[2] }, VoxelsThatHold);
}

std::array<double, 2> PyramidLevels::Range(int level) const
{
  std::array<double, 2> range;
  this->Voxels[level]->GetRange(range.data());
  return range;
}

LevelImage PyramidLevels::Load(int wanted, double base, Executor& executor)
{
  const int level = std::max(wanted, 0);
  vtkImageData* image = this->Images[level];
  const std::string name = "level " + std::to_string(level);
  CheckSize(image, name, "Set Coarsest Level to a finer level.");
  const vtkSmartPointer<vtkDataArray> voxels = ContiguousVoxels(this->Voxels[level]);
  const std::string notFinite =
    DescribeNotFiniteVoxels(this->Voxels[level], voxels, image, executor);
  if (!notFinite.empty())
  {
    Refuse(name, ": ", notFinite);
  }
  // Sums and differences of voxels must not overflow either.
  constexpr double largest = 1e37;
  const std::array<double, 2> range = this->Range(level);
  const double size = std::max(std::abs(range[0]), std::abs(range[1]));
  if (size > largest)
  {
    Refuse(name, ": ", NameOf(this->Voxels[level]), " has values of ", size, " in size; at most ",
      largest, " can be used, since the surface computes in single precision. Scale the image.");
  }

  LevelImage loaded;
  const bool isFine = FloatHolds(range[0], range[1]);
  if (voxels->GetDataType() == VTK_FLOAT && voxels == this->Voxels[level] && isFine)
  {
    this->Converted = std::vector<float>();
    loaded.Values = static_cast<const float*>(voxels->GetVoidPointer(0));
  }
  else
  {
    this->Converted = std::vector<float>();
    this->Converted.resize(static_cast<std::size_t>(image->GetNumberOfPoints()));
    switch (voxels->GetDataType())
    {
      vtkTemplateMacro(
        Convert(
          static_cast<const VTK_TT*>(voxels->GetVoidPointer(0)), base, this->Converted, executor));
      default:
        Refuse(name, ": ", NameOf(voxels), " has voxels of type ", voxels->GetDataTypeAsString(),
          ", which is not supported.");
    }
    loaded.Values = this->Converted.data();
    loaded.Base = base;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    loaded.Size[axis] = image->GetDimensions()[axis];
    loaded.Step[axis] = this->Space.Step()[axis] *
      static_cast<double>(this->Images[0]->GetDimensions()[axis]) / loaded.Size[axis];
  }
  loaded.Unit = this->UnitOf(wanted);
  return loaded;
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "AttractionInputs.h"

#include "BuildPyramid.h"
#include "Core/Common/Refuse.h"
#include "ImageVoxels.h"
#include "PolyDataPoints.h"
#include "vtkImagePyramid.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace volumic
{
namespace
{
/// The array of that name, null if there is none.
vtkDataArray* NumbersOf(vtkPolyData* polyData, const char* name)
{
  vtkAbstractArray* found = polyData->GetPointData()->GetAbstractArray(name);
  auto* numbers = vtkDataArray::SafeDownCast(found);
  if (found && (!numbers || numbers->GetNumberOfComponents() != 1))
  {
    Refuse("the point array ", name, " must hold one number per point.");
  }
  return numbers;
}

double NumberAt(vtkDataArray* numbers, vtkIdType id, double missing)
{
  const double value = numbers ? numbers->GetComponent(id, 0) : missing;
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    Refuse(numbers->GetName(), " of point ", id, " is ", value, "; it must be 0 or more.");
  }
  return value;
}

/// The name chosen, empty for the active scalars.
std::string NameIn(vtkInformation* selection)
{
  const char* name = selection->Has(vtkDataObject::FIELD_NAME())
    ? selection->Get(vtkDataObject::FIELD_NAME())
    : nullptr;
  return name ? name : "";
}

double FactorOf(vtkMultiBlockDataSet* blocks)
{
  const auto unit = [blocks](unsigned int h)
  {
    auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    vtkDataArray* array = image ? image->GetFieldData()->GetArray("Unit") : nullptr;
    return array && array->GetNumberOfTuples() == 1 ? array->GetTuple1(0) : 0.0;
  };
  const double factor = blocks->GetNumberOfBlocks() > 1 ? unit(1) / unit(0) : 0.0;
  return factor > 1.0 && factor < 2.0 ? factor : std::sqrt(3.0);
}
}

std::vector<AttractingPoint> AttractingPointsOf(
  vtkPolyData* polyData, const Workspace& space, const std::array<int, 3>& size)
{
  std::vector<AttractingPoint> attracting;
  if (!polyData)
  {
    return attracting;
  }
  vtkDataArray* weights = NumbersOf(polyData, "Weight");
  vtkDataArray* radii = NumbersOf(polyData, "Radius");
  for (const vtkIdType id : PointsMeantBy(polyData))
  {
    AttractingPoint point;
    Point world;
    polyData->GetPoint(id, world.data());
    point.Place = space.ToWorkspace(world);
    for (int axis = 0; axis < 3; ++axis)
    {
      // A voxel of tolerance: there the field still ramps down to the background.
      const double step = space.Step()[axis];
      if (!(point.Place[axis] >= -step && point.Place[axis] <= step * size[axis]))
      {
        Refuse("point ", id, " (", world[0], ", ", world[1], ", ", world[2],
          ") lies outside the image. Points are in world coordinates; leave it out.");
      }
    }
    point.Weight = NumberAt(weights, id, 1.0);
    point.Radius = NumberAt(radii, id, 0.0) / space.WorldUnit();
    attracting.push_back(point);
  }
  return attracting;
}

EdgeLevels::EdgeLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection,
  int numberOfThreads, const Checkpoint& goOn)
{
  const bool isChosen = selection && (selection->Has(vtkDataObject::FIELD_NAME()) ||
                                       selection->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()));
  if (!isChosen)
  {
    Refuse("Edge Attraction Weight is not 0, but there is no map of edges: choose a second point "
           "array of the image as Edge Map (SetInputArrayToProcess(1, ...)), such as its gradient "
           "magnitude.");
  }
  auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(0));
  try
  {
    ChooseVoxels(selection, image);
    const std::string name = NameIn(selection);
    bool everywhere = !name.empty();
    for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
    {
      auto* level = vtkImageData::SafeDownCast(blocks->GetBlock(h));
      everywhere = everywhere && level && level->GetPointData()->HasArray(name.c_str());
    }
    this->Blocks = blocks;
    if (!everywhere && blocks->GetNumberOfBlocks() > 1)
    {
      vtkNew<vtkImagePyramid> pyramid;
      pyramid->SetNumberOfLevels(static_cast<int>(blocks->GetNumberOfBlocks()));
      pyramid->SetReductionFactor(FactorOf(blocks));
      pyramid->SetNumberOfThreads(numberOfThreads);
      this->Blocks = BuildPyramid(pyramid, image, selection, goOn);
    }
    if (!this->Blocks)
    {
      return;
    }
    this->Levels = std::make_unique<PyramidLevels>(this->Blocks, selection, Metric::Voxels);
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0, the map of edges: ", error.what());
  }
}

const float* EdgeLevels::Load(int level, const std::array<int, 3>& size, Executor& executor)
{
  try
  {
    // The force knows differences only.
    const double lowest = this->Levels->Range(0)[0];
    const LevelImage loaded = level < this->Levels->NumberOfLevels()
      ? this->Levels->Load(level, lowest, lowest, executor)
      : LevelImage();
    if (loaded.Size != size)
    {
      Refuse("its level ", level, " has ", loaded.Size[0], " x ", loaded.Size[1], " x ",
        loaded.Size[2], " voxels, that of the voxels ", size[0], " x ", size[1], " x ", size[2],
        ". Give the image instead of its pyramid, or one whose blocks all carry both arrays.");
    }
    return loaded.Values;
  }
  catch (const std::invalid_argument& error)
  {
    Refuse("Input port 0, the map of edges: ", error.what());
  }
}
}

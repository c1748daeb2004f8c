// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid/EdgeLevels.h"

#include "Core/Common/ContentHash.h"
#include "Core/Common/Refuse.h"
#include "Host/PrefixErrors.h"
#include "Input/ImageVoxels.h"
#include "Pyramid/BuildPyramid.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <string>

namespace volumic
{
namespace
{
constexpr const char* Place = "Input port 0, the map of edges: ";

/** The blocks where all of them carry the map, else the pyramid of block 0's; null after a stop. */
vtkSmartPointer<vtkMultiBlockDataSet> LevelsOfMap(vtkMultiBlockDataSet* blocks,
  vtkInformation* selection, int numberOfThreads, const ProgressQuestion& goOn)
{
  auto* image = vtkImageData::SafeDownCast(blocks->GetBlock(0));
  ChooseVoxels(selection, image);
  const std::string name = ChosenName(selection);
  bool everywhere = !name.empty();
  for (unsigned int h = 0; h < blocks->GetNumberOfBlocks(); ++h)
  {
    auto* level = vtkImageData::SafeDownCast(blocks->GetBlock(h));
    everywhere = everywhere && level && level->GetPointData()->HasArray(name.c_str());
  }
  if (everywhere || blocks->GetNumberOfBlocks() <= 1)
  {
    return blocks;
  }
  PyramidRequest request;
  request.Levels = LevelsAs(blocks);
  request.NumberOfThreads = numberOfThreads;
  request.Progress = [&goOn](double share, const std::string&) { return goOn(share); };
  return BuildPyramid(image, selection, -1, request);
}
}

EdgeLevels::EdgeLevels(vtkMultiBlockDataSet* blocks, vtkInformation* selection,
  int numberOfThreads, const ProgressQuestion& goOn)
{
  const bool isChosen = selection && (selection->Has(vtkDataObject::FIELD_NAME()) ||
                                       selection->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()));
  if (!isChosen)
  {
    Refuse("Edge Attraction Weight is not 0, but there is no map of edges: choose a second point "
           "array of the image as Edge Map (SetInputArrayToProcess(1, ...)), such as its gradient "
           "magnitude.");
  }
  PrefixErrors(Place,
    [&]
    {
      const vtkSmartPointer<vtkMultiBlockDataSet> levels =
        LevelsOfMap(blocks, selection, numberOfThreads, goOn);
      if (levels)
      {
        this->Levels = std::make_unique<PyramidLevels>(levels, selection, Metric::Voxels);
      }
    });
}

VoxelValues EdgeLevels::Load(int level, const std::array<int, 3>& size, Executor& executor)
{
  return PrefixErrors(Place,
    [&]
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
    });
}

std::uint64_t EdgeLevels::HashOfVoxels(Executor& threads) const
{
  std::uint64_t hash = 0;
  for (int level = 0; this->Levels && level < this->Levels->NumberOfLevels(); ++level)
  {
    hash = CombineHashes(hash, this->Levels->HashOfVoxels(level, threads));
  }
  return hash;
}
}

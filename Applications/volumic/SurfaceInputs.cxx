// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInputs.h"

#include "BinaryFile.h"
#include "InputFiles.h"
#include "LoadVolume.h"
#include "Ranks.h"
#include "ReadStart.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDeformableSurface.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace tool
{
namespace
{
/** What the file holds, on the first rank; pieces without points on the others. */
template <class Read>
vtkSmartPointer<vtkPolyData> ReadOnFirst(Ranks& ranks, const Read& read, const std::string& name)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  ranks.OnFirst(
    [&]
    {
      NeedFile(name);
      data = read(name);
    });
  return data;
}

/** @return the name of the array of the volume that is the map. */
std::string AddEdges(const ToolOptions& options, vtkImageData* volume,
  vtkDeformableSurface* filter, vtkImagePyramid* holder, const Announcer& announcer)
{
  std::string name = options.Edges;
  vtkPointData* points = volume->GetPointData();
  if (!points->HasArray(name.c_str()))
  {
    const vtkSmartPointer<vtkImageData> edges =
      LoadVoxels(options.Edges, "", filter, holder, announcer).Image;
    FailIf(!std::equal(edges->GetDimensions(), edges->GetDimensions() + 3, volume->GetDimensions()),
      options.Edges + ": its size differs from the volume's");
    name = "Edges";
    while (points->HasArray(name.c_str()))
    {
      name += "_";
    }
    edges->GetPointData()->GetScalars()->SetName(name.c_str());
    points->AddArray(edges->GetPointData()->GetScalars());
  }
  return name;
}
}

std::vector<std::string> InputsOf(const ToolOptions& options)
{
  std::vector<std::string> inputs = FilesOfVolume(options.Volume);
  const std::vector<std::string> edges = FilesOfVolume(options.Edges);
  inputs.insert(inputs.end(), edges.begin(), edges.end());
  inputs.insert(
    inputs.end(), { options.Seeds, options.InitialSurface, options.AttractingPoints });
  return inputs;
}

void CheckInputsOnAll(const ToolOptions& options, Ranks& ranks)
{
  if (ranks.IsOne())
  {
    return;
  }
  std::vector<std::string> files = InputsOf(options);
  if (files.empty() || files.front() != options.Volume)
  {
    files.insert(files.begin(), options.Volume);
  }
  for (std::string& file : files)
  {
    std::error_code failed;
    const bool isThere = std::filesystem::exists(file, failed);
    const auto size = std::filesystem::file_size(file, failed);
    file += !isThere ? ": no such file or folder"
                     : failed ? "" : ": a file of " + std::to_string(size) + " bytes";
  }
  const std::optional<Ranks::Difference> difference = ranks.FindDifference(files);
  ranks.Together(
    [&difference]
    {
      if (difference)
      {
        throw Failure((difference->Here.empty() ? "finds fewer files" : difference->Here) +
          ", where the first rank finds " +
          (difference->First.empty() ? "fewer files" : difference->First) +
          "; all ranks need the same files, from a disk that they share");
      }
    });
}

void SetStart(const ToolOptions& options, vtkDeformableSurface* filter, Ranks& ranks)
{
  const bool isChosen = options.HasProperty("Initialization");
  for (const auto& place : options.SeedPositions)
  {
    filter->AddSeedPosition(place[0], place[1], place[2]);
  }
  for (const auto& place : options.AttractingPositions)
  {
    filter->AddAttractingPosition(place[0], place[1], place[2]);
  }
  if (!options.Seeds.empty())
  {
    filter->SetInitialSurfaceData(ReadOnFirst(ranks, ReadSeeds, options.Seeds));
  }
  if (!options.Seeds.empty() || !options.SeedPositions.empty())
  {
    if (!isChosen)
    {
      filter->SetInitializationToSeeds();
    }
  }
  else if (!options.InitialSurface.empty())
  {
    filter->SetInitialSurfaceData(ReadOnFirst(ranks, ReadSurface, options.InitialSurface));
    if (!isChosen)
    {
      filter->SetInitializationToInputSurface();
    }
  }
  if (!options.AttractingPoints.empty())
  {
    filter->SetAttractingPointsData(
      ReadOnFirst(ranks, ReadAttractingPoints, options.AttractingPoints));
  }
}

void SetEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer, Ranks& ranks)
{
  if (options.Edges.empty())
  {
    return;
  }
  std::string name;
  ranks.OnFirst([&] { name = AddEdges(options, volume, filter, holder, announcer); });
  name = ranks.Broadcast(std::move(name));
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name.c_str());
  if (!options.HasProperty("EdgeAttractionWeight"))
  {
    filter->SetEdgeAttractionWeight(2.0);
  }
}
}

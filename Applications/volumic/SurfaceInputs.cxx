// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceInputs.h"

#include "Announcer.h"
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
#include <string>

namespace tool
{
namespace
{
/** What the file holds, on the first rank; pieces without points on the others. */
template <class Read>
vtkSmartPointer<vtkPolyData> ReadOnFirst(Ranks& ranks, const Read& read, const std::string& name)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  ranks.OnFirst([&] { data = read(name); });
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
    if (!std::equal(edges->GetDimensions(), edges->GetDimensions() + 3, volume->GetDimensions()))
    {
      throw Failure(options.Edges + ": its size differs from the volume's");
    }
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

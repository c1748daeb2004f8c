// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LoadInputs.h"

#include "BinaryFile.h"
#include "LabelNames.h"
#include "Messages.h"
#include "ReadStart.h"
#include "ReadVolume.h"
#include "ResampleImage.h"
#include "RunFilter.h"
#include "SurfaceProperties.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "VolumeImage.h"

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>

namespace tool
{
namespace
{
/** Level 0 of the holder's pyramid: all slabs of the source, one behind the other. */
vtkSmartPointer<vtkImageData> GatherSlabs(
  const std::string& name, vtkAlgorithm* source, vtkImagePyramid* holder, ProgressStyle style)
{
  VtkMessages messages;
  messages.ListenTo(source);
  std::string failure;
  bool isInterrupted = false;
  messages.Catch(
    [&]
    {
      try
      {
        isInterrupted = RunFilter(holder, "Reading the volume", style).IsInterrupted;
      }
      catch (const Failure& error)
      {
        failure = error.what();
      }
    });
  // What a reader warns of are data that it lacked and made up.
  messages.Errors.insert(messages.Errors.end(), messages.Warnings.begin(), messages.Warnings.end());
  messages.ThrowErrors(name);
  FailIf(!failure.empty(), name + ": " + failure);
  auto image = vtkSmartPointer<vtkImageData>::New();
  auto* level = vtkImageData::SafeDownCast(holder->GetOutput()->GetBlock(0));
  FailIf(!level,
    isInterrupted ? "interrupted before there was a surface; nothing is written"
                  : name + ": holds no image");
  image->ShallowCopy(level);
  vtkNew<vtkFieldData> fields; // A copy of its own, without those of a level.
  fields->ShallowCopy(level->GetFieldData());
  fields->RemoveArray("Level");
  fields->RemoveArray("Unit");
  image->SetFieldData(fields);
  return image;
}
}

vtkSmartPointer<vtkImageData> LoadWhole(const std::string& name, const std::string& array,
  const VolumeChoice& choice, const Announcer& announcer)
{
  vtkSmartPointer<vtkImageData> image;
  announcer.Follow(name, [&] { image = ReadVolume(name, choice); });
  Named(name, [&] { ChooseScalars(image, array); });
  return image;
}

LoadedVoxels LoadVoxels(const std::string& name, const std::string& array,
  const VolumeChoice& choice, vtkDeformableSurface* filter, vtkImagePyramid* holder,
  const Announcer& announcer)
{
  LoadedVoxels loaded;
  vtkSmartPointer<vtkImageData>& image = loaded.Image;
  if (filter->GetMemoryLimit() == 0)
  {
    image = LoadWhole(name, array, choice, announcer);
  }
  else
  {
    OpenedVolume opened;
    announcer.Follow(
      name, [&] { opened = OpenVolume(name, array, filter->GetScratchDirectory(), choice); });
    if (!opened.Whole.empty())
    {
      announcer.Say("warning: " + name + ": volumes of this kind (" + opened.Whole +
        ") are read as a whole, whatever --memory says; it is kept from then on");
    }
    opened.Source->ReleaseDataFlagOn();
    holder->SetInputConnection(opened.Source->GetOutputPort());
    if (!array.empty())
    {
      holder->SetInputArrayToProcess(
        0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array.c_str());
    }
    holder->SetNumberOfLevels(1);
    ShareWithPyramid(filter, holder);
    image = GatherSlabs(name, opened.Source, holder, announcer.Style);
    loaded.Components = ComponentsIn(VoxelsIn(opened.Source->GetOutputInformation(0), array));
    holder->RemoveAllInputs();
    Named(name, [&] { ChooseScalars(image, array); });
  }
  loaded.Components =
    std::max(loaded.Components, image->GetPointData()->GetScalars()->GetNumberOfComponents());
  return loaded;
}

namespace
{
/** @param components that the file has */
void Announce(const ToolOptions& options, const VolumeFacts& facts, int components, int component,
  const Announcer& announcer)
{
  const auto times = [](auto a, auto b, auto c)
  { return NumberText(a) + " x " + NumberText(b) + " x " + NumberText(c); };
  const std::array<int, 3> size = facts.Size();
  const std::string taken = components == 1
    ? ""
    : ", " + (component < 0 ? "magnitude" : "component " + NumberText(component)) + " of " +
      NumberText(components) + " components (--component)";
  const std::string range = facts.Range[0] > facts.Range[1] // There is no such component.
    ? ""
    : ", " + NumberText(facts.Range[0]) + " to " + NumberText(facts.Range[1]);
  announcer.Say(options.Volume + ": " + times(size[0], size[1], size[2]) + " voxels of " +
    times(facts.Spacing[0], facts.Spacing[1], facts.Spacing[2]) + ", " +
    vtkImageScalarTypeNameMacro(facts.Type) + taken + range + facts.World.Text());
}

}

LoadedVolume LoadVolume(const ToolOptions& options, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  const LoadedVoxels loaded =
    LoadVoxels(options.Volume, options.Array, options.Choice, filter, holder, announcer);
  LoadedVolume volume;
  volume.Image = loaded.Image;
  const WorldSpace world =
    Named(options.Volume, [&] { return PlaceInWorld(volume.Image, options.World); });
  if (filter->GetMemoryLimit() == 0)
  {
    CropAsAsked(options, volume.Image);
    ResampleAsAsked(options, false, volume.Image, announcer);
  }
  const int component = filter->GetSelectedComponent();
  volume.Facts = FactsOf(volume.Image, volume.Image->GetPointData()->GetScalars(), component);
  volume.Facts.World = world;
  Announce(options, volume.Facts, loaded.Components, component, announcer);
  return volume;
}

// ---- What else a surface is made of -------------------------------------------------------------

namespace
{
/** @return the name of the array of the volume that is the map. */
std::string AddEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  std::string name = options.Edges;
  vtkPointData* points = volume->GetPointData();
  if (!points->HasArray(name.c_str()))
  {
    const vtkSmartPointer<vtkImageData> edges =
      LoadVoxels(options.Edges, "", {}, filter, holder, announcer).Image;
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
  for (const std::string& probe : options.Probes)
  {
    const std::vector<std::string> files = FilesOfVolume(probe);
    inputs.insert(inputs.end(), files.begin(), files.end());
  }
  inputs.insert(inputs.end(),
    { options.Seeds, options.InitialSurface, options.AttractingPoints, options.NamesOfLabels });
  const std::vector<std::string> names =
    options.Labels.empty() ? std::vector<std::string>() : FilesBeside(options.Volume);
  inputs.insert(inputs.end(), names.begin(), names.end());
  return inputs;
}

void SetStart(const ToolOptions& options, vtkDeformableSurface* filter)
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
    NeedFile(options.Seeds);
    filter->SetInitialSurfaceData(ReadSeeds(options.Seeds));
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
    NeedFile(options.InitialSurface);
    filter->SetInitialSurfaceData(ReadSurface(options.InitialSurface));
    if (!isChosen)
    {
      filter->SetInitializationToInputSurface();
    }
  }
  if (!options.AttractingPoints.empty())
  {
    NeedFile(options.AttractingPoints);
    filter->SetAttractingPointsData(ReadAttractingPoints(options.AttractingPoints));
  }
}

void SetEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  if (options.Edges.empty())
  {
    return;
  }
  const std::string name = AddEdges(options, volume, filter, holder, announcer);
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name.c_str());
  if (!options.HasProperty("EdgeAttractionWeight"))
  {
    filter->SetEdgeAttractionWeight(2.0);
  }
}
}

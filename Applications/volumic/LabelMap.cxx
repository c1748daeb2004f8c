// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelMap.h"

#include "LabelNames.h"
#include "LoadInputs.h"
#include "ReadVolume.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>

#include <algorithm>

namespace tool
{
namespace
{
/** Make an array of cells the active one, if the option or the lack of others means it. */
bool ChooseCells(vtkImageData* image, const std::string& array)
{
  vtkPointData* points = image->GetPointData();
  vtkCellData* cells = image->GetCellData();
  const bool isMeant = array.empty()
    ? points->GetNumberOfArrays() == 0 && (cells->GetScalars() || cells->GetNumberOfArrays() == 1)
    : !points->HasArray(array.c_str()) && cells->HasArray(array.c_str());
  if (!isMeant)
  {
    return false;
  }
  vtkDataArray* labels = !array.empty() ? cells->GetArray(array.c_str())
    : cells->GetScalars()               ? cells->GetScalars()
                                        : cells->GetArray(0);
  FailIf(!labels, "the cell array " + array + " holds no numbers");
  if (!labels->GetName())
  {
    labels->SetName("Intensity");
  }
  cells->SetActiveScalars(labels->GetName());
  return true;
}

/** The volume as it is, without a limit of memory. */
vtkSmartPointer<vtkImageData> ReadWhole(const ToolOptions& options, bool& isOfCells)
{
  const vtkSmartPointer<vtkImageData> image = ReadVolume(options.Volume);
  Named(options.Volume,
    [&]
    {
      isOfCells = ChooseCells(image, options.Array);
      if (!isOfCells)
      {
        ChooseScalars(image, options.Array);
      }
    });
  return image;
}

vtkDataSetAttributes* AttributesOf(vtkImageData* image, bool isOfCells)
{
  return isOfCells ? static_cast<vtkDataSetAttributes*>(image->GetCellData())
                   : image->GetPointData();
}

/** An image of one component, with the names of that layer. */
vtkSmartPointer<vtkImageData> LayerOf(
  vtkImageData* image, bool isOfCells, int component, const LabelNames& names)
{
  vtkDataArray* all = AttributesOf(image, isOfCells)->GetScalars();
  const auto one = vtkSmartPointer<vtkDataArray>::Take(all->NewInstance());
  one->SetName(all->GetName());
  one->SetNumberOfComponents(1);
  one->SetNumberOfTuples(all->GetNumberOfTuples());
  one->CopyComponent(0, all, component);
  auto layer = vtkSmartPointer<vtkImageData>::New();
  layer->CopyStructure(image);
  AttributesOf(layer, isOfCells)->SetScalars(one);
  LabelNames own;
  for (LabelName name : names)
  {
    if (name.Layer == component)
    {
      name.Layer = 0;
      own.push_back(name);
    }
  }
  SetLabelNames(layer, own);
  return layer;
}

/** Those that the image has, or else the file. */
LabelNames OwnNames(const ToolOptions& options, vtkImageData* image)
{
  const LabelNames own = GetLabelNames(image);
  return own.empty() ? ReadNamesWithin(options.Volume) : own;
}

VolumeFacts FactsOfMap(const LabelMap& map)
{
  VolumeFacts facts =
    FactsOf(map.Image, AttributesOf(map.Image, map.IsOfCells)->GetScalars(), -1);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    facts.Extent[2 * axis + 1] -= map.IsOfCells ? 1 : 0;
  }
  return facts;
}

/** The components that are label maps. */
std::vector<int> ComponentsOf(
  const ToolOptions& options, int components, int component, const LabelNames& own)
{
  FailIf(component >= components,
    options.Volume + ": there is no component " + NumberText(component) +
      " (--component); voxels have " + NumberText(components));
  if (components == 1 || component >= 0)
  {
    return { std::max(component, 0) };
  }
  std::vector<int> layers;
  for (int layer = 0; layer < components; ++layer)
  {
    if (std::any_of(own.begin(), own.end(),
          [layer](const LabelName& name) { return name.Layer == layer; }))
    {
      layers.push_back(layer);
    }
  }
  FailIf(layers.empty(),
    options.Volume + ": voxels have " + NumberText(components) +
      " components; choose the one that is a label with --component");
  return layers;
}
}

LabelMap LoadLabelMap(const ToolOptions& options, vtkDeformableSurface* settings,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  LabelMap map;
  const int component = settings->GetSelectedComponent();
  if (settings->GetMemoryLimit() > 0)
  {
    const LoadedVoxels loaded =
      LoadVoxels(options.Volume, options.Array, settings, holder, announcer);
    const bool isOne = loaded.Components == 1 || component >= 0;
    map.Image = isOne ? loaded.Image : ReadWhole(options, map.IsOfCells);
  }
  else
  {
    map.Image = ReadWhole(options, map.IsOfCells);
  }
  if (options.Spacing)
  {
    map.Image->SetSpacing(options.Spacing->data());
  }
  const LabelNames own = OwnNames(options, map.Image);
  map.Facts = FactsOfMap(map);
  const bool isTaken = settings->GetMemoryLimit() > 0 && component >= 0; // out of the others
  const std::vector<int> components =
    ComponentsOf(options, map.Facts.Components, isTaken ? -1 : component, own);
  NameLabels(options, map.Image, announcer);
  if (map.Facts.Components == 1)
  {
    map.Layers = { map.Image };
    return map;
  }
  const LabelNames names = GetLabelNames(map.Image);
  for (const int each : components)
  {
    map.Layers.push_back(LayerOf(map.Image, map.IsOfCells, each, names));
  }
  return map;
}

void NameLabels(const ToolOptions& options, vtkImageData* image, const Announcer& announcer)
{
  const LabelNames own = OwnNames(options, image);
  if (!options.NamesOfLabels.empty())
  {
    SetLabelNames(image, Merged(own, ReadLabelNames(options.NamesOfLabels)));
    return;
  }
  SetLabelNames(image, own);
  const bool isAsked = !options.Labels.empty();
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const bool mayHaveLabels = scalars && scalars->GetDataType() != VTK_FLOAT &&
    scalars->GetDataType() != VTK_DOUBLE;
  if (!own.empty() || !(isAsked || mayHaveLabels))
  {
    return;
  }
  const NamesBeside beside = ReadNamesBeside(options.Volume);
  SetLabelNames(image, beside.Names);
  if (!isAsked)
  {
    return;
  }
  for (const std::string& refused : beside.Refused)
  {
    announcer.Say("warning: " + refused + "; it is passed over");
  }
  if (!beside.File.empty())
  {
    announcer.Say("names of labels are those of " + beside.File);
  }
}
}

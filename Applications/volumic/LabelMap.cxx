// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelMap.h"

#include "LoadInputs.h"
#include "MaskFolder.h"
#include "ReadVolume.h"
#include "ResampleImage.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <algorithm>
#include <fnmatch.h>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace tool
{
namespace
{
/** An image of one component, with the names of that layer. */
vtkSmartPointer<vtkImageData> LayerOf(vtkImageData* image, int component, const LabelNames& names)
{
  vtkDataArray* all = image->GetPointData()->GetScalars();
  const auto one = vtkSmartPointer<vtkDataArray>::Take(all->NewInstance());
  one->SetName(all->GetName());
  one->SetNumberOfComponents(1);
  one->SetNumberOfTuples(all->GetNumberOfTuples());
  one->CopyComponent(0, all, component);
  auto layer = vtkSmartPointer<vtkImageData>::New();
  layer->CopyStructure(image);
  layer->GetPointData()->SetScalars(one);
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
    if (std::any_of(
          own.begin(), own.end(), [layer](const LabelName& name) { return name.Layer == layer; }))
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

namespace
{
/** A label map, or, where nothing tells which of several volumes in the file it is, masks. */
vtkSmartPointer<vtkImageData> LoadLabels(const ToolOptions& options, const Announcer& announcer)
{
  VolumeChoice choice = options.Choice;
  choice.Times = std::make_shared<int>(1);
  choice.Time = choice.Time.value_or(0);
  vtkSmartPointer<vtkImageData> image = LoadWhole(options.Volume, options.Array, choice, announcer);
  if (!options.Choice.Time && *choice.Times > 1)
  {
    announcer.Follow(options.Volume,
      [&] { image = ReadMasksOf(options.Volume, image, *choice.Times, options.Choice); });
    announcer.Say(options.Volume + ": " + std::to_string(*choice.Times) +
      " volumes, one behind the other, are taken for masks of labels 1 to " +
      std::to_string(*choice.Times) + "; --time chooses one of them");
  }
  return image;
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
      LoadVoxels(options.Volume, options.Array, options.Choice, settings, holder, announcer);
    map.Image = loaded.Components == 1 || component >= 0 ? loaded.Image : nullptr;
  }
  map.Image = map.Image ? map.Image : LoadLabels(options, announcer);
  const WorldSpace world =
    Named(options.Volume, [&] { return PlaceInWorld(map.Image, options.World); });
  CropAsAsked(options, map.Image);
  ResampleAsAsked(options, true, map.Image, announcer);
  const LabelNames own = OwnNames(options, map.Image);
  map.Facts = FactsOf(map.Image, map.Image->GetPointData()->GetScalars(), -1);
  map.Facts.World = world;
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
    map.Layers.push_back(LayerOf(map.Image, each, names));
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
  const bool mayHaveLabels =
    scalars && scalars->GetDataType() != VTK_FLOAT && scalars->GetDataType() != VTK_DOUBLE;
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

// ---- Which labels -------------------------------------------------------------------------------

namespace
{
/** Places of the labels that pass. */
template <class Test>
std::vector<std::size_t> Find(const std::vector<KnownLabel>& known, const Test& passes)
{
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    if (passes(known[i]))
    {
      found.push_back(i);
    }
  }
  return found;
}

/** Whether it has a name, and not only a number. */
bool IsNamed(const KnownLabel& label)
{
  return label.Name != "Label " + std::to_string(label.Label);
}

/** By the name, of other case if there is none of this; else by the names that a pattern means. */
std::vector<std::size_t> FindNamed(
  const std::string& text, const std::vector<KnownLabel>& known, int background)
{
  std::vector<std::size_t> same =
    Find(known, [&](const KnownLabel& label) { return label.Name == text; });
  if (same.empty())
  {
    same = Find(known, [&](const KnownLabel& label) { return Lower(label.Name) == Lower(text); });
  }
  if (!same.empty() || text.find('*') == std::string::npos)
  {
    return same;
  }
  // Brackets and so on are letters of names.
  std::string pattern;
  for (const char c : Lower(text))
  {
    pattern += (c == '*' ? "" : "\\") + std::string(1, c);
  }
  return Find(known,
    [&](const KnownLabel& label)
    {
      return IsNamed(label) && label.Label != background &&
        fnmatch(pattern.c_str(), Lower(label.Name).c_str(), 0) == 0;
    });
}

/** What one text asks for; empty if there is no such label. */
std::vector<std::size_t> FindText(
  const std::string& text, const std::vector<KnownLabel>& known, int background)
{
  if (const std::optional<int> value = AsNumber<int>(text))
  {
    return Find(known, [&](const KnownLabel& label) { return label.Label == *value; });
  }
  const std::vector<std::size_t> named = FindNamed(text, known, background);
  if (!named.empty())
  {
    return named;
  }
  if (Lower(text) == "all")
  {
    return Find(known, [&](const KnownLabel& label) { return label.Label != background; });
  }
  // "7-9", also of negative numbers: "-9--7".
  const std::size_t dash = std::min(text.find('-', 1), text.size());
  const std::optional<int> first = AsNumber<int>(text.substr(0, dash));
  const std::optional<int> last = AsNumber<int>(text.substr(std::min(dash + 1, text.size())));
  return Find(known,
    [&](const KnownLabel& label)
    {
      return first && last && label.Label >= *first && label.Label <= *last &&
        label.Label != background;
    });
}

/** The labels for a message, not all if there are many. */
std::string ListOf(const std::vector<KnownLabel>& known)
{
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(known.size(), most); ++i)
  {
    list += (i > 0 ? ", " : "") + std::to_string(known[i].Label) +
      (IsNamed(known[i]) ? " " + known[i].Name : "");
  }
  return list +
    (known.size() > most ? " and " + std::to_string(known.size() - most) + " more" : "");
}
}

std::vector<KnownLabel> LabelsOf(vtkTable* table, int layer)
{
  std::vector<KnownLabel> labels;
  auto* colors = vtkDataArray::SafeDownCast(table->GetColumnByName("Color"));
  auto* extents = vtkIntArray::SafeDownCast(table->GetColumnByName("Extent"));
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    KnownLabel label;
    label.Label = table->GetValueByName(row, "Label").ToInt();
    label.Name = table->GetValueByName(row, "Name").ToString();
    label.Voxels = table->GetValueByName(row, "Voxels").ToTypeInt64();
    colors->GetTuple(row, label.Color.data());
    extents->GetTypedTuple(row, label.Box.data());
    label.Layer = layer;
    labels.push_back(label);
  }
  return labels;
}

std::vector<std::size_t> ChooseLabels(
  const std::vector<std::string>& texts, const std::vector<KnownLabel>& known, int background)
{
  std::set<std::size_t> chosen;
  for (const std::string& text : texts)
  {
    // A name may have commas.
    const bool isName = !FindNamed(text, known, background).empty();
    for (const std::string& part : isName ? std::vector<std::string>{ text } : SplitAtCommas(text))
    {
      const std::vector<std::size_t> found = FindText(part, known, background);
      FailIf(found.empty() && Lower(part) != "all",
        "there is no label '" + part + "' (--labels); there are " +
          (known.empty() ? "none" : ListOf(known)));
      chosen.insert(found.begin(), found.end());
    }
  }
  return { chosen.begin(), chosen.end() };
}

std::vector<KnownLabel> NumberedLabels(
  const std::vector<std::string>& texts, const LabelNames& names)
{
  std::set<int> numbers;
  for (const std::string& text : texts)
  {
    for (const std::string& part : SplitAtCommas(text))
    {
      const std::optional<int> value = AsNumber<int>(part);
      if (!value)
      {
        return {};
      }
      numbers.insert(*value);
    }
  }
  std::vector<KnownLabel> known;
  for (const int number : numbers)
  {
    known.push_back({ number, "Label " + std::to_string(number) });
    for (const LabelName& name : names)
    {
      const bool isIts = name.Label == number && !name.Name.empty();
      known.back().Name = isIts ? name.Name : known.back().Name;
    }
  }
  return known;
}

std::vector<std::string> FileNamesOf(const std::vector<KnownLabel>& known)
{
  std::vector<std::string> names;
  std::map<std::string, int> uses;
  for (const KnownLabel& label : known)
  {
    const std::string safe = IsNamed(label) ? SafeName(label.Name) : "";
    names.push_back(safe.empty() ? "label-" + std::to_string(label.Label) : safe);
    ++uses[Lower(names.back())];
  }
  DistinctNames distinct("-");
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const bool isShared = uses[Lower(names[i])] > 1;
    names[i] = distinct.Take(isShared ? names[i] + "-" + std::to_string(known[i].Label) : names[i]);
  }
  return names;
}
}

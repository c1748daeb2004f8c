// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelNames.h"

#include "BinaryFile.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

std::string ReadText(const std::string& name)
{
  FailIf(fs::is_directory(name), "it is a folder");
  BinaryFile file(name);
  FailIf(file.Size() > LargestNames, "it is too large for a list of names of labels");
  std::string text = file.Text(0, file.Size());
  FailIf(text.find('\0') != std::string::npos, "it is no text in UTF-8");
  const std::string mark = "\xEF\xBB\xBF"; // with which some programs begin UTF-8
  return AsUtf8(text.compare(0, mark.size(), mark) == 0 ? text.substr(mark.size()) : text);
}

/** What the names of files beside a volume begin with: a.nii.gz has a.nii and a. */
std::vector<std::string> StemsOf(const std::string& volume)
{
  std::vector<std::string> stems;
  fs::path stem = volume;
  for (const char* suffix : { ".gz", "" })
  {
    if (stem.has_extension() && (*suffix == '\0' || SuffixOf(stem.string()) == suffix))
    {
      stem.replace_extension();
      stems.push_back(stem.string());
    }
  }
  if (!stems.empty() && (EndsWith(Lower(stems.back()), ".seg")))
  {
    stems.push_back(fs::path(stems.back()).replace_extension().string());
  }
  return stems;
}
}

LabelNames ReadLabelNames(const std::string& file)
{
  try
  {
    const std::string text = ReadText(file);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool isJson = SuffixOf(file) == ".json" ||
      (first != std::string::npos && (text[first] == '{' || text[first] == '['));
    LabelNames names = isJson ? ParseLabelJson(text) : ParseLabelTable(text);
    FailIf(names.empty(), "it names no label");
    for (LabelName& name : names)
    {
      name.Name = PlainName(name.Name);
    }
    ScaleColors(names);
    // Of two names of a label the first one counts.
    std::stable_sort(names.begin(), names.end(),
      [](const LabelName& a, const LabelName& b) { return a.Label < b.Label; });
    names.erase(std::unique(names.begin(), names.end(),
                  [](const LabelName& a, const LabelName& b) { return a.Label == b.Label; }),
      names.end());
    return names;
  }
  catch (const Failure& failure)
  {
    throw Failure(file + ": names of labels cannot be read: " + failure.what());
  }
}

std::string PlainName(std::string text)
{
  std::replace_if(
    text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return Trimmed(AsUtf8(text));
}

LabelNames ReadNamesWithin(const std::string& volume)
{
  const std::string lower = Lower(volume);
  try
  {
    if (EndsWith(lower, ".nrrd") || EndsWith(lower, ".nhdr"))
    {
      return NamesInNrrd(volume);
    }
    if (EndsWith(lower, ".nii") || EndsWith(lower, ".nii.gz"))
    {
      return NamesInNifti(volume);
    }
  }
  catch (const std::runtime_error&)
  {
    // Names are not worth a volume.
  }
  return {};
}

std::vector<std::string> FilesBeside(const std::string& volume)
{
  std::vector<std::string> files;
  if (!fs::is_regular_file(volume))
  {
    return files;
  }
  std::vector<std::string> candidates;
  for (const std::string& stem : StemsOf(volume))
  {
    for (const char* suffix : { ".label", ".txt", ".ctbl", ".json", ".csv", ".tsv" })
    {
      candidates.push_back(stem + suffix);
    }
  }
  const fs::path folder = fs::path(volume).parent_path();
  candidates.push_back((folder / "dataset.json").string());
  candidates.push_back((folder / ".." / "dataset.json").string());
  std::error_code failed;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(files),
    [&](const std::string& file)
    { return fs::is_regular_file(file, failed) && !fs::equivalent(file, volume, failed); });
  return files;
}

NamesBeside ReadNamesBeside(const std::string& volume)
{
  NamesBeside beside;
  for (const std::string& file : FilesBeside(volume))
  {
    try
    {
      beside.Names = ReadLabelNames(file);
      beside.File = file;
      return beside;
    }
    catch (const Failure& failure)
    {
      beside.Refused.emplace_back(failure.what());
    }
  }
  return beside;
}

void SetLabelNames(vtkImageData* image, const LabelNames& names)
{
  vtkNew<vtkIntArray> values;
  values->SetName("LabelValues");
  vtkNew<vtkStringArray> texts;
  texts->SetName("LabelNames");
  vtkNew<vtkDoubleArray> colors;
  colors->SetName("LabelColors");
  colors->SetNumberOfComponents(3);
  vtkNew<vtkIntArray> layers;
  layers->SetName("LabelLayers");
  bool areInLayers = false;
  for (const LabelName& name : names)
  {
    values->InsertNextValue(name.Label);
    texts->InsertNextValue(name.Name);
    colors->InsertNextTuple(name.Color.value_or(Vector3()).data());
    layers->InsertNextValue(name.Layer);
    areInLayers = areInLayers || name.Layer > 0;
  }
  const bool haveColors = std::all_of(
    names.begin(), names.end(), [](const LabelName& name) { return name.Color.has_value(); });
  vtkFieldData* fields = image->GetFieldData();
  for (const char* array : { "LabelValues", "LabelNames", "LabelColors", "LabelLayers" })
  {
    fields->RemoveArray(array);
  }
  if (names.empty())
  {
    return;
  }
  fields->AddArray(values);
  fields->AddArray(texts);
  if (haveColors)
  {
    fields->AddArray(colors);
  }
  if (areInLayers)
  {
    fields->AddArray(layers);
  }
}

LabelNames GetLabelNames(vtkImageData* image)
{
  LabelNames names;
  vtkFieldData* fields = image->GetFieldData();
  vtkDataArray* values = fields->GetArray("LabelValues");
  auto* texts = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelNames"));
  vtkDataArray* colors = fields->GetArray("LabelColors");
  vtkDataArray* layers = fields->GetArray("LabelLayers");
  const vtkIdType count = values ? values->GetNumberOfTuples() : 0;
  const auto fits = [count](vtkAbstractArray* array, int components)
  {
    return array && array->GetNumberOfTuples() == count &&
      array->GetNumberOfComponents() == components;
  };
  const double scale = colors && colors->GetDataType() == VTK_UNSIGNED_CHAR ? 1.0 / 255.0 : 1.0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double value = values->GetComponent(i, 0);
    if (!(std::abs(value) <= std::numeric_limits<int>::max()))
    {
      continue; // an array of something else
    }
    LabelName name;
    name.Label = static_cast<int>(value);
    name.Name = fits(texts, 1) ? std::string(texts->GetValue(i)) : "";
    if (fits(colors, 3))
    {
      const double* color = colors->GetTuple(i);
      name.Color = { color[0] * scale, color[1] * scale, color[2] * scale };
    }
    name.Layer = fits(layers, 1) ? static_cast<int>(layers->GetComponent(i, 0)) : 0;
    names.push_back(name);
  }
  return names;
}

LabelNames Merged(const LabelNames& names, const LabelNames& others)
{
  LabelNames merged = names;
  std::multimap<int, std::size_t> places; // of labels, which several layers may have
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    places.emplace(names[i].Label, i);
  }
  for (const LabelName& other : others)
  {
    const auto [first, last] = places.equal_range(other.Label);
    for (auto place = first; place != last; ++place)
    {
      LabelName& name = merged[place->second];
      name.Name = other.Name.empty() ? name.Name : other.Name;
      name.Color = other.Color ? other.Color : name.Color;
    }
    if (first == last)
    {
      places.emplace(other.Label, merged.size());
      merged.push_back(other);
    }
  }
  return merged;
}

void ScaleColors(LabelNames& names)
{
  double largest = 0.0;
  for (const LabelName& name : names)
  {
    for (const double part : name.Color.value_or(Vector3()))
    {
      FailIf(!(part >= 0.0 && part <= 255.0),
        "the colour of label " + std::to_string(name.Label) + " is not between 0 and 255");
      largest = std::max(largest, part);
    }
  }
  for (LabelName& name : names)
  {
    if (name.Color && largest > 1.0)
    {
      for (double& part : *name.Color)
      {
        part /= 255.0;
      }
    }
  }
}

std::optional<Vector3> ParseHexColor(const std::string& text)
{
  const bool isOne = (text.size() == 7 || text.size() == 9) && text[0] == '#' &&
    text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!isOne)
  {
    return std::nullopt;
  }
  const unsigned long code = std::strtoul(text.substr(1, 6).c_str(), nullptr, 16);
  return Vector3{ static_cast<double>(code >> 16), static_cast<double>(code >> 8 & 0xFF),
    static_cast<double>(code & 0xFF) };
}
}

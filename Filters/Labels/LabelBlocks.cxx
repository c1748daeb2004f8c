// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelBlocks.h"

#include "Output/SurfaceOutput.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>

namespace volumic
{
namespace
{
/** How many labels or messages a warning names. */
constexpr std::size_t MostNamed = 10;

/** Of all voxels, those without a surface that are worth a warning; less is told as field data. */
constexpr double NotableShare = 0.05;

template <typename Array, typename Value>
void AddField(vtkPolyData* surface, const char* name, const std::vector<Value>& values,
  int components = 1)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (const Value& value : values)
  {
    array->InsertNextValue(value);
  }
  surface->GetFieldData()->AddArray(array);
}

/** The labels of the triangles; of a merged surface the nearest one's. */
void AddLabels(vtkPolyData* surface, const std::vector<int>& labels, const LabelImage& image)
{
  vtkNew<vtkIntArray> array;
  array->SetName("Label");
  array->SetNumberOfTuples(surface->GetNumberOfCells());
  if (labels.size() == 1)
  {
    array->FillValue(labels.front());
  }
  else
  {
    image.FindNearest(surface, labels, array);
  }
  surface->GetCellData()->AddArray(array);
}

/** What each of the labels is called, and its colour. */
void AddNames(vtkPolyData* surface, const std::vector<int>& labels, const LabelNames& names)
{
  std::vector<std::string> texts;
  std::vector<double> colors;
  for (const int label : labels)
  {
    texts.push_back(names.NameOf(label));
    const LabelNames::Color color = names.ColorOf(label);
    colors.insert(colors.end(), color.begin(), color.end());
  }
  AddField<vtkStringArray>(surface, "LabelName", texts);
  AddField<vtkDoubleArray>(surface, "LabelColor", colors, 3);
}

/** Why what is there may not be in a surface, and what helps, if anything does. */
std::string ReasonsOfLoss(const LabelSettings& settings)
{
  std::string reasons = ": too small, scattered, or too thin for the triangles";
  reasons += settings.KeepComponents != 0 ? ", or left out by Keep Components" : "";
  reasons += ".";
  if (settings.EdgeLength > 0.0)
  {
    reasons += " A shorter Edge Length makes these smaller.";
  }
  else if (settings.FinestLevel > 0)
  {
    reasons += " A lower Finest Level makes these smaller.";
  }
  return reasons;
}

/** Whether the volume of a label of so many voxels is off, and no setting brings that about. */
bool HasWrongVolume(const LabelSurface& surface, vtkIdType voxels, const LabelSettings& settings)
{
  constexpr vtkIdType least = 100;
  constexpr double most = 0.03;
  const bool hasLargeTriangles = settings.FinestLevel > 0 || settings.EdgeLength > 0.0;
  return voxels >= least && std::abs(surface.VolumeError) > most && !hasLargeTriangles &&
    settings.KeepComponents == 0;
}

std::string ToPercent(double share)
{
  const int percent = static_cast<int>(std::lround(100.0 * share));
  return (percent > 0 ? "+" : "") + std::to_string(percent) + " %";
}

std::string JoinedBy(const char* separator, const std::vector<std::string>& texts)
{
  std::string all;
  for (const std::string& text : texts)
  {
    all += (all.empty() ? "" : separator) + text;
  }
  return all;
}

/** Text after text, as many as a warning names. */
std::string Listed(const std::vector<std::string>& texts)
{
  std::string list;
  for (std::size_t i = 0; i < std::min(texts.size(), MostNamed); ++i)
  {
    list += (i == 0 ? "" : ", ") + texts[i];
  }
  if (texts.size() > MostNamed)
  {
    list += " and " + std::to_string(texts.size() - MostNamed) + " others";
  }
  return list;
}
}

std::vector<int> LabelChoice::LabelsOf(std::size_t surface) const
{
  return this->IsMerged ? this->Labels : std::vector<int>{ this->Labels[surface] };
}

std::vector<int> LabelChoice::FirstLabels() const
{
  std::vector<int> labels;
  for (std::size_t i = 0; i < this->NumberOfSurfaces(); ++i)
  {
    labels.push_back(this->LabelsOf(i).front());
  }
  return labels;
}

std::vector<std::string> LabelChoice::SurfaceNames() const
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < this->NumberOfSurfaces(); ++i)
  {
    names.push_back(this->Names.NameOf(this->LabelsOf(i)));
  }
  return names;
}

std::string FillBlocks(const LabelChoice& choice, const LabelImage& image,
  const LabelSettings& settings, const std::vector<LabelSurface>& surfaces,
  vtkMultiBlockDataSet* output, const std::string& stopped)
{
  std::vector<std::string> empty;
  std::vector<std::string> lost;
  std::vector<std::string> wrongVolumes;
  double sought = 0.0;  // voxels of all labels
  double missing = 0.0; // those without a surface that nobody has chosen to be without
  output->SetNumberOfBlocks(static_cast<unsigned int>(surfaces.size()));
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    const std::vector<int> labels = choice.LabelsOf(i);
    vtkIdType voxels = 0;
    for (const int label : labels)
    {
      voxels += image.Labels().at(label).Count;
    }
    const std::string name = choice.Names.NameOf(labels);
    vtkNew<vtkPolyData> surface;
    const bool isThere = surfaces[i].Surface != nullptr;
    surface->ShallowCopy(isThere ? surfaces[i].Surface : MakeStopped(0, stopped));
    if (!surfaces[i].IsFinished)
    {
      SetStopReason(surface, stopped);
    }
    AddLabels(surface, labels, image);
    AddField<vtkIntArray>(surface, "Label", labels);
    AddNames(surface, labels, choice.Names);
    AddField<vtkIdTypeArray>(surface, "LabelVoxels", std::vector<vtkIdType>{ voxels });
    AddField<vtkIdTypeArray>(
      surface, "WrongVoxels", std::vector<vtkIdType>{ surfaces[i].WrongVoxels });
    AddField<vtkIdTypeArray>(
      surface, "MissedVoxels", std::vector<vtkIdType>{ surfaces[i].MissedVoxels });
    AddField<vtkDoubleArray>(
      surface, "VolumeError", std::vector<double>{ surfaces[i].VolumeError });
    const auto block = static_cast<unsigned int>(i);
    output->SetBlock(block, surface);
    output->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), name.c_str());
    sought += static_cast<double>(voxels);
    // What is not finished may still come.
    if (surfaces[i].IsFinished && surface->GetNumberOfCells() == 0)
    {
      empty.push_back(name);
      missing += static_cast<double>(voxels);
    }
    else if (surfaces[i].IsFinished && 2 * surfaces[i].MissedVoxels > voxels)
    {
      lost.push_back(name);
      missing += settings.KeepComponents == 0 ? static_cast<double>(surfaces[i].MissedVoxels) : 0.0;
    }
    else if (surfaces[i].IsFinished && HasWrongVolume(surfaces[i], voxels, settings))
    {
      wrongVolumes.push_back(name + " (" + ToPercent(surfaces[i].VolumeError) + ")");
      missing += std::abs(surfaces[i].VolumeError) * static_cast<double>(voxels);
    }
  }
  std::vector<std::string> losses;
  if (!empty.empty())
  {
    losses.push_back("No surface is left of " + Listed(empty) + ReasonsOfLoss(settings));
  }
  if (!lost.empty())
  {
    losses.push_back("More voxels than half are on the wrong side of the surface of " +
      Listed(lost) + ReasonsOfLoss(settings));
  }
  if (!wrongVolumes.empty())
  {
    losses.push_back("The volume is not that of the voxels of " + Listed(wrongVolumes) +
      ReasonsOfLoss(settings));
  }
  if (!losses.empty())
  {
    vtkNew<vtkStringArray> told;
    told->SetName("LostLabels");
    told->InsertNextValue(JoinedBy(" ", losses));
    output->GetFieldData()->AddArray(told);
  }
  return missing > NotableShare * sought ? JoinedBy(" ", losses) : "";
}

void AddLabelFields(const LabelChoice& choice, const LabelImage& image, vtkPolyData* surface)
{
  std::vector<vtkIdType> voxels;
  for (const int label : choice.Labels)
  {
    voxels.push_back(image.Labels().at(label).Count);
  }
  AddField<vtkIntArray>(surface, "Label", choice.Labels);
  AddNames(surface, choice.Labels, choice.Names);
  AddField<vtkIdTypeArray>(surface, "LabelVoxels", voxels);
}
}

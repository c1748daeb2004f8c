// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Labels/LabelBlocks.h"

#include "Core/Common/Join.h"
#include "Host/Pipeline.h"
#include "Output/SurfaceOutput.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
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
constexpr std::size_t MaximumNamed = 10;

/** Fraction of missing voxels above which there is a warning, not only field data. */
constexpr double NotableFraction = 0.05;

template <typename Array, typename Value>
void AddField(
  vtkPolyData* surface, const char* name, const std::vector<Value>& values, int components = 1)
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

/** Add the labels of the triangles: in a merged surface the nearest one. */
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

/** Collects labels that are not represented well by their surfaces. */
class Losses
{
public:
  explicit Losses(const LabelSettings& settings) : Settings(settings) {}

  /** @param isEmpty whether the surface has no triangles */
  void Add(const std::string& name, const LabelSurface& surface, vtkIdType voxels, bool isEmpty)
  {
    const auto count = static_cast<double>(voxels);
    this->Voxels += count;
    if (!surface.IsFinished)
    {
      return;
    }
    if (isEmpty)
    {
      this->Empty.push_back(name);
      this->Missing += count;
    }
    else if (2 * surface.MissedVoxels > voxels)
    {
      this->Missed.push_back(name);
      this->Missing += this->Settings.KeepComponents == 0 ? surface.MissedVoxels : 0.0;
    }
    else if (this->HasWrongVolume(surface, voxels))
    {
      const long percent = std::lround(100.0 * surface.VolumeError);
      this->WrongVolumes.push_back(Join(name, percent > 0 ? " (+" : " (", percent, " %)"));
      this->Missing += std::abs(surface.VolumeError) * count;
    }
    if (surface.MisclassifiedParts > 0)
    {
      this->MisclassifiedParts.push_back(
        Join(name, " (", surface.MisclassifiedParts, " of ", surface.Parts, ")"));
    }
  }

  bool AreNotable() const { return this->Missing > NotableFraction * this->Voxels; }

  std::string Text() const
  {
    std::string text;
    const auto add = [&](const char* problem, const std::vector<std::string>& names)
    {
      if (!names.empty())
      {
        text += Join(text.empty() ? "" : " ", problem, Listed(names, MaximumNamed), this->Advice());
      }
    };
    add("These labels have no surface: ", this->Empty);
    add("More than half of the voxels are misclassified for ", this->Missed);
    add("The enclosed volume differs from the voxels for ", this->WrongVolumes);
    add("The enclosed volume of parts differs from their voxels for ", this->MisclassifiedParts);
    return text;
  }

private:
  bool HasLargeTriangles() const
  {
    return this->Settings.FinestLevel > 0 || this->Settings.EdgeLength > 0.0;
  }

  /** Return whether the volume is wrong, and no setting explains this. */
  bool HasWrongVolume(const LabelSurface& surface, vtkIdType voxels) const
  {
    constexpr vtkIdType least = 100;
    constexpr double most = 0.03;
    return voxels >= least && std::abs(surface.VolumeError) > most && !this->HasLargeTriangles() &&
      this->Settings.KeepComponents == 0;
  }

  /** Return possible reasons, and settings that help. */
  std::string Advice() const
  {
    return Join(". They are too small, scattered, or too thin for the triangles",
      this->Settings.KeepComponents != 0 ? ", or removed by Keep Components." : ".",
      !this->HasLargeTriangles()         ? ""
        : this->Settings.EdgeLength > 0. ? " Set a shorter Edge Length."
                                         : " Set a lower Finest Level.");
  }

  const LabelSettings& Settings;
  std::vector<std::string> Empty;
  std::vector<std::string> Missed;
  std::vector<std::string> WrongVolumes;
  std::vector<std::string> MisclassifiedParts;
  double Voxels = 0.0;
  double Missing = 0.0;
};
}

std::string FillBlocks(const LabelChoice& choice, const LabelImage& image,
  const LabelSettings& settings, const std::vector<LabelSurface>& surfaces,
  vtkMultiBlockDataSet* output, const std::string& stopped)
{
  Losses losses(settings);
  const std::vector<std::string> names = choice.BlockNames();
  MakeNullBlocks(output, names);
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    const LabelSurface& made = surfaces[i];
    const std::vector<int> labels = choice.LabelsOf(i);
    vtkIdType voxels = 0;
    for (const int label : labels)
    {
      voxels += image.Labels().at(label).Count;
    }
    vtkNew<vtkPolyData> surface;
    surface->ShallowCopy(made.Surface ? made.Surface : MakeStopped(0, stopped));
    if (!made.IsFinished)
    {
      SetStopReason(surface, stopped);
    }
    AddLabels(surface, labels, image);
    AddField<vtkIntArray>(surface, "Label", labels);
    AddNames(surface, labels, choice.Names);
    AddField<vtkIdTypeArray, vtkIdType>(surface, "LabelVoxels", { voxels });
    AddField<vtkIdTypeArray, vtkIdType>(surface, "WrongVoxels", { made.MisclassifiedVoxels });
    AddField<vtkIdTypeArray, vtkIdType>(surface, "MissedVoxels", { made.MissedVoxels });
    AddField<vtkDoubleArray, double>(surface, "VolumeError", { made.VolumeError });
    AddField<vtkIdTypeArray, vtkIdType>(surface, "Parts", { made.Parts });
    AddField<vtkIdTypeArray, vtkIdType>(surface, "WrongParts", { made.MisclassifiedParts });
    output->SetBlock(static_cast<unsigned int>(i), surface);
    losses.Add(names[i], made, voxels, surface->GetNumberOfCells() == 0);
  }
  const std::string text = losses.Text();
  if (!text.empty())
  {
    vtkNew<vtkStringArray> missed;
    missed->SetName("LostLabels");
    missed->InsertNextValue(text);
    output->GetFieldData()->AddArray(missed);
  }
  return losses.AreNotable() ? text : "";
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

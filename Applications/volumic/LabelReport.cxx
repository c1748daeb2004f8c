// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelReport.h"

#include "Json.h"
#include "Report.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace tool
{
namespace
{
Json NameFacts(const LabelSurface& surface)
{
  vtkIdType voxels = 0;
  std::vector<int> labels;
  for (const KnownLabel& label : surface.Labels)
  {
    labels.push_back(label.Label);
    voxels += label.Voxels;
  }
  if (vtkDataArray* counted = surface.Surface->GetFieldData()->GetArray("LabelVoxels"))
  {
    voxels = static_cast<vtkIdType>(counted->GetComponent(0, 0));
  }
  Json facts = Json::object();
  if (labels.size() == 1)
  {
    facts["label"] = labels[0];
  }
  facts["labels"] = labels;
  facts["name"] = surface.Name;
  facts["color"] = AsJsonArray(surface.Labels[0].Color);
  facts["layer"] = surface.Labels[0].Layer;
  facts["voxels"] = voxels;
  facts["files"] = surface.Files;
  return facts;
}
}

vtkIdType WrongVoxels(vtkPolyData* surface, const char* name)
{
  vtkDataArray* wrong = surface->GetFieldData()->GetArray(name);
  return wrong && wrong->GetNumberOfTuples() > 0
    ? static_cast<vtkIdType>(wrong->GetComponent(0, 0))
    : 0;
}

std::string ReportText(const LabelReport& report)
{
  Json json = { { "input", InputFacts(report.VolumeName, report.Volume) },
    { "finished", report.IsFinished }, { "labels", Json::array() } };
  for (const LabelSurface& each : report.Surfaces)
  {
    vtkPolyData* surface = each.Surface;
    Json& facts = json["labels"].emplace_back(NameFacts(each));
    facts["seconds"] = each.Seconds;
    facts["wrong_voxels"] = WrongVoxels(surface);
    facts["missed_voxels"] = WrongVoxels(surface, "MissedVoxels");
    AddSurfaceFacts(facts, surface, { surface->GetNumberOfPoints(), surface->GetNumberOfPolys() });
    facts["component_features"] = ComponentFeatures(surface);
  }
  json["seconds"] = { { "surface", report.Seconds } };
  json["memory"] = MemoryFacts(report.ReaderMemory, report.PeaksByRank);
  json["properties"] = PropertyValues(report.Filters, IsOfLabels);
  return EndedReport(json, report.Warnings);
}

// ---- The list of labels -------------------------------------------------------------------------

namespace
{
using Row = std::vector<std::string>;

double VolumeOf(const KnownLabel& label, const VolumeFacts& volume)
{
  const Vector3& spacing = volume.Spacing;
  return static_cast<double>(label.Voxels) * spacing[0] * spacing[1] * spacing[2];
}

/** Six digits, but no powers of ten. */
std::string SixDigits(double value)
{
  const int digits = value > 0.0 ? 5 - static_cast<int>(std::floor(std::log10(value))) : 0;
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", std::clamp(digits, 0, 30), value);
  return text;
}

std::string BoxText(const std::array<int, 6>& box)
{
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    text += (axis > 0 ? " " : "") + std::to_string(box[2 * axis]) + ".." +
      std::to_string(box[2 * axis + 1]);
  }
  return text;
}

Row RowOf(const KnownLabel& label, const LabelList& list)
{
  Row row = { std::to_string(label.Label), std::to_string(label.Voxels),
    SixDigits(VolumeOf(label, list.Volume)) };
  if (list.Layers > 1)
  {
    row.push_back(std::to_string(label.Layer));
  }
  row.push_back(BoxText(label.Box));
  row.push_back(PlainName(label.Name)); // the last, as it may be long
  return row;
}
}

void WriteTable(std::ostream& out, const LabelList& list)
{
  std::vector<Row> rows = { { "label", "voxels", "volume" } };
  if (list.Layers > 1)
  {
    rows.front().push_back("layer");
  }
  rows.front().emplace_back("box (first..last voxel along i, j, k)");
  rows.front().emplace_back("name");
  for (const KnownLabel& label : list.Labels)
  {
    rows.push_back(RowOf(label, list));
  }
  for (const Row& row : rows)
  {
    for (std::size_t column = 0; column < row.size(); ++column)
    {
      std::size_t width = 0;
      for (const Row& other : rows)
      {
        width = std::max(width, other[column].size());
      }
      const bool isLast = column + 1 == row.size();
      const std::string blanks(isLast ? 0 : width - row[column].size(), ' ');
      const bool isNumber = column + 2 < row.size();
      out << (isNumber ? blanks + row[column] : row[column] + blanks) << (isLast ? "\n" : "  ");
    }
  }
}

std::string ReportText(const LabelList& list)
{
  Json json = { { "input", InputFacts(list.VolumeName, list.Volume) },
    { "labels", Json::array() } };
  for (const KnownLabel& label : list.Labels)
  {
    json["labels"].push_back({ { "label", label.Label }, { "name", label.Name },
      { "color", AsJsonArray(label.Color) }, { "layer", label.Layer },
      { "voxels", label.Voxels }, { "volume", AsJson(VolumeOf(label, list.Volume)) },
      { "box", label.Box } });
  }
  return EndedReport(json, list.Warnings);
}
}

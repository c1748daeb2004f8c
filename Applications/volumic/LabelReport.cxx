// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelReport.h"

#include "JsonWriter.h"
#include "Report.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>

namespace tool
{
namespace
{
void WriteNames(JsonWriter& json, const LabelSurface& surface)
{
  double voxels = 0;
  std::vector<double> labels;
  for (const KnownLabel& label : surface.Labels)
  {
    labels.push_back(label.Label);
    voxels += static_cast<double>(label.Voxels);
  }
  if (vtkDataArray* counted = surface.Surface->GetFieldData()->GetArray("LabelVoxels"))
  {
    voxels = counted->GetComponent(0, 0);
  }
  if (labels.size() == 1)
  {
    json.Member("label", labels[0]);
  }
  json.Numbers("labels", labels.data(), static_cast<int>(labels.size()));
  json.Member("name", surface.Name);
  json.Numbers("color", surface.Labels[0].Color.data(), 3);
  json.Member("layer", surface.Labels[0].Layer);
  json.Member("voxels", voxels);
  json.Name("files");
  json.BeginArray();
  for (const std::string& file : surface.Files)
  {
    json.Value(file);
  }
  json.EndArray();
}
}

vtkIdType WrongVoxels(vtkPolyData* surface, const char* name)
{
  vtkDataArray* wrong = surface->GetFieldData()->GetArray(name);
  return wrong && wrong->GetNumberOfTuples() > 0
    ? static_cast<vtkIdType>(wrong->GetComponent(0, 0))
    : 0;
}

void WriteReport(std::ostream& out, const LabelReport& report)
{
  JsonWriter json(out);
  json.BeginObject();
  WriteInput(json, report.VolumeName, report.Volume);
  json.Member("finished", report.IsFinished);
  json.Name("labels");
  json.BeginArray();
  for (const LabelSurface& each : report.Surfaces)
  {
    vtkPolyData* surface = each.Surface;
    json.BeginObject();
    WriteNames(json, each);
    json.Member("seconds", each.Seconds);
    json.Member("wrong_voxels", static_cast<double>(WrongVoxels(surface)));
    json.Member("missed_voxels", static_cast<double>(WrongVoxels(surface, "MissedVoxels")));
    WriteSurfaceFacts(
      json, surface, { surface->GetNumberOfPoints(), surface->GetNumberOfPolys() });
    WriteComponents(json, surface);
    json.EndObject();
  }
  json.EndArray();
  json.Name("seconds");
  json.BeginObject();
  json.Member("surface", report.Seconds);
  json.EndObject();
  WriteMemory(json, report.ReaderMemory, report.PeaksByRank);
  WriteProperties(json, report.Filters, IsOfLabels);
  WriteEnd(json, report.Warnings);
  json.EndObject();
}
}

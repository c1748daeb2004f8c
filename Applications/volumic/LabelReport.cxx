// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelReport.h"

#include "Json.h"
#include "Report.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>

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
}

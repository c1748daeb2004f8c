// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Json.h"
#include "Ranks.h"
#include "SurfaceFields.h"

#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkVariant.h>
#include <vtkVersion.h>

#include <cstdlib>
#include <functional>
#include <map>

#include <sys/resource.h>

namespace tool
{
Json InputFacts(const std::string& name, const VolumeFacts& volume)
{
  return { { "name", name }, { "dimensions", volume.Size() },
    { "spacing", AsJsonArray(volume.Spacing) }, { "origin", AsJsonArray(volume.Origin) },
    { "scalar_type", vtkImageScalarTypeNameMacro(volume.Type) },
    { "range", AsJsonArray(volume.Range) } };
}

void AddSurfaceFacts(Json& json, vtkPolyData* surface, const SurfaceSize& size)
{
  static const char* const facts[][2] = { { "components", "NumberOfComponents" },
    { "genus", "Genus" }, { "euler_characteristic", "EulerCharacteristic" }, { "area", "Area" },
    { "volume", "Volume" }, { "delta", "Delta" }, { "unit", "Unit" }, { "level", "Level" },
    { "iterations", "Iterations" }, { "lost_parts", "LostParts" },
    { "recovered_parts", "RecoveredParts" }, { "missing_parts", "MissingParts" },
    { "missing_boundary", "MissingBoundary" } };
  for (const auto& [name, array] : facts)
  {
    if (vtkDataArray* values = surface->GetFieldData()->GetArray(array))
    {
      json[name] = AsJson(values->GetComponent(0, 0));
    }
  }
  json["vertices"] = size.Vertices;
  json["triangles"] = size.Triangles;
  json["stop_reason"] = StopReason(surface);
}

Json ComponentFeatures(vtkPolyData* surface)
{
  static const char* const facts[][2] = { { "area", "ComponentArea" },
    { "volume", "ComponentVolume" }, { "genus", "ComponentGenus" },
    { "centroid", "ComponentCentroid" }, { "inertia", "ComponentInertia" } };
  vtkFieldData* fields = surface->GetFieldData();
  vtkDataArray* areas = fields->GetArray("ComponentArea");
  Json components = Json::array();
  for (vtkIdType c = 0; areas && c < areas->GetNumberOfTuples(); ++c)
  {
    Json& component = components.emplace_back(Json::object());
    for (const auto& [name, array] : facts)
    {
      if (vtkDataArray* values = fields->GetArray(array))
      {
        const double* tuple = values->GetTuple(c);
        const int count = values->GetNumberOfComponents();
        component[name] = count == 1
          ? AsJson(*tuple)
          : AsJsonArray(std::vector<double>(tuple, tuple + count));
      }
    }
  }
  return components;
}

namespace
{
double SecondsOfRow(vtkTable* history, vtkIdType row)
{
  double seconds = 0.0;
  for (const char* column : { "SecondsBefore", "Seconds", "SecondsAfter" })
  {
    seconds += history->GetValueByName(row, column).ToDouble();
  }
  return seconds;
}

/** What levels took, by their rows: those that `counts` says yes to. */
template <typename Counts>
double SecondsOf(vtkTable* history, const Counts& counts)
{
  double seconds = 0.0;
  for (vtkIdType row = 0; row < history->GetNumberOfRows(); ++row)
  {
    const double level = history->GetValueByName(row, "Level").ToDouble();
    seconds += counts(level) ? SecondsOfRow(history, row) : 0.0;
  }
  return seconds;
}

/**
 * The visited levels from the coarsest to the finest; the surface may have vanished at one. Their
 * seconds add up to those of the run.
 */
Json LevelFacts(const ReportInput& input)
{
  vtkMultiBlockDataSet* levels = input.Filters.Surface->GetLevels();
  vtkTable* history = input.Filters.Surface->GetHistory();
  std::map<double, unsigned int, std::greater<double>> blocks;
  for (unsigned int block = 0; block < levels->GetNumberOfBlocks(); ++block)
  {
    if (auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(block)))
    {
      // The last block may be level -1.
      blocks[surface->GetFieldData()->GetArray("Level")->GetComponent(0, 0)] = block;
    }
  }
  Json told = Json::array();
  for (const auto& [level, block] : blocks)
  {
    Json& facts = told.emplace_back(Json::object());
    AddSurfaceFacts(
      facts, vtkPolyData::SafeDownCast(levels->GetBlock(block)), input.LevelSizes.at(block));
    const double own = level;
    facts["seconds"] = SecondsOf(history, [own](double of) { return of == own; });
  }
  return told;
}

/** Those of the whole surface, and, after --resume, of that what a run before has taken. */
Json SecondsOf(const ReportInput& input)
{
  vtkDeformableSurface* filter = input.Filters.Surface;
  const int resumed = filter->GetResumedLevel();
  const bool isResumed = resumed >= -1;
  const double before = isResumed
    ? SecondsOf(filter->GetHistory(), [resumed](double of) { return of >= resumed; })
    : 0.0;
  Json seconds = { { "pyramid", input.PyramidSeconds },
    { "surface", before + input.SurfaceSeconds } };
  if (isResumed)
  {
    seconds["taken_over"] = before;
  }
  return seconds;
}
}

Json PropertyValues(const FilterTrio& filters, bool (*isMeant)(const PropertyOption&))
{
  Json values = Json::object();
  for (const PropertyOption& property : SurfaceProperties())
  {
    if (isMeant(property))
    {
      values[property.Property] = property.Get(filters);
    }
  }
  return values;
}

Json MemoryFacts(double reader, const std::vector<double>& byRank)
{
  Json memory = { { "reader", reader }, { "peak", PeakMemory() } };
  if (!byRank.empty())
  {
    memory["peak_by_rank"] = byRank;
  }
  return memory;
}

std::vector<double> PeaksByRank(const Ranks& ranks)
{
  std::vector<double> peaks;
  if (!ranks.IsOne())
  {
    for (const std::string& peak : ranks.GatherOnAll(std::to_string(PeakMemory())))
    {
      peaks.push_back(std::atof(peak.c_str()));
    }
  }
  return peaks;
}

double PeakMemory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string ReportText(const ReportInput& input)
{
  vtkDeformableSurface* filter = input.Filters.Surface;
  vtkPolyData* surface = filter->GetOutput();
  Json json = { { "input", InputFacts(input.VolumeName, input.Volume) },
    { "iso_value", AsJson(filter->GetIsoValue()) }, { "finished", input.IsFinished } };
  AddSurfaceFacts(json, surface, input.Size);
  json["component_features"] = ComponentFeatures(surface);
  json["levels"] = LevelFacts(input);
  json["seconds"] = SecondsOf(input);
  json["memory"] = MemoryFacts(input.ReaderMemory, input.PeaksByRank);
  json["properties"] = PropertyValues(input.Filters,
    [](const PropertyOption& property) { return !IsOfLabelsOnly(property); });
  return EndedReport(json, input.Warnings);
}

std::string EndedReport(Json& json, const std::vector<std::string>& warnings)
{
  json["warnings"] = warnings;
  json["versions"] = { { "volumic", VOLUMIC_VERSION }, { "vtk", vtkVersion::GetVTKVersion() } };
  return TextOf(json);
}
}

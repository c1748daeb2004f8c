// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "JsonWriter.h"
#include "ParseNumbers.h"
#include "Ranks.h"
#include "SurfaceFields.h"

#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkVariant.h>
#include <vtkVersion.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <map>

#include <sys/resource.h>

namespace tool
{
void WriteInput(JsonWriter& json, const std::string& name, const VolumeFacts& volume)
{
  double numbers[3];
  json.Name("input");
  json.BeginObject();
  json.Member("name", name);
  const std::array<int, 3> size = volume.Size();
  std::copy_n(size.begin(), 3, numbers);
  json.Numbers("dimensions", numbers, 3);
  json.Numbers("spacing", volume.Spacing.data(), 3);
  json.Numbers("origin", volume.Origin.data(), 3);
  json.Member("scalar_type", vtkImageScalarTypeNameMacro(volume.Type));
  json.Numbers("range", volume.Range.data(), 2);
  json.EndObject();
}

void WriteSurfaceFacts(JsonWriter& json, vtkPolyData* surface, const SurfaceSize& size)
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
      json.Member(name, values->GetComponent(0, 0));
    }
  }
  json.Member("vertices", static_cast<double>(size.Vertices));
  json.Member("triangles", static_cast<double>(size.Triangles));
  json.Member("stop_reason", StopReason(surface));
}

void WriteComponents(JsonWriter& json, vtkPolyData* surface)
{
  static const char* const facts[][2] = { { "area", "ComponentArea" },
    { "volume", "ComponentVolume" }, { "genus", "ComponentGenus" },
    { "centroid", "ComponentCentroid" }, { "inertia", "ComponentInertia" } };
  vtkFieldData* fields = surface->GetFieldData();
  vtkDataArray* areas = fields->GetArray("ComponentArea");
  json.Name("component_features");
  json.BeginArray();
  for (vtkIdType c = 0; areas && c < areas->GetNumberOfTuples(); ++c)
  {
    json.BeginObject();
    for (const auto& [name, array] : facts)
    {
      vtkDataArray* values = fields->GetArray(array);
      if (values && values->GetNumberOfComponents() == 1)
      {
        json.Member(name, values->GetComponent(c, 0));
      }
      else if (values)
      {
        json.Numbers(name, values->GetTuple(c), values->GetNumberOfComponents());
      }
    }
    json.EndObject();
  }
  json.EndArray();
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
void WriteLevels(JsonWriter& json, const ReportInput& input)
{
  vtkMultiBlockDataSet* levels = input.Filters.Surface->GetLevels();
  vtkTable* history = input.Filters.Surface->GetHistory();
  std::map<double, unsigned int, std::greater<double>> blocks;
  for (unsigned int block = 0; block < levels->GetNumberOfBlocks(); ++block)
  {
    auto* surface = vtkPolyData::SafeDownCast(levels->GetBlock(block));
    if (surface)
    {
      // The last block may be level -1.
      blocks[surface->GetFieldData()->GetArray("Level")->GetComponent(0, 0)] = block;
    }
  }
  json.Name("levels");
  json.BeginArray();
  for (const auto& [level, block] : blocks)
  {
    json.BeginObject();
    WriteSurfaceFacts(
      json, vtkPolyData::SafeDownCast(levels->GetBlock(block)), input.LevelSizes.at(block));
    const double own = level;
    json.Member("seconds", SecondsOf(history, [own](double of) { return of == own; }));
    json.EndObject();
  }
  json.EndArray();
}

/** Those of the whole surface, and, after --resume, of that what a run before has taken. */
void WriteSeconds(JsonWriter& json, const ReportInput& input)
{
  vtkDeformableSurface* filter = input.Filters.Surface;
  const int resumed = filter->GetResumedLevel();
  const bool isResumed = resumed >= -1;
  const double before = isResumed
    ? SecondsOf(filter->GetHistory(), [resumed](double of) { return of >= resumed; })
    : 0.0;
  json.Name("seconds");
  json.BeginObject();
  json.Member("pyramid", input.PyramidSeconds);
  json.Member("surface", before + input.SurfaceSeconds);
  if (isResumed)
  {
    json.Member("taken_over", before);
  }
  json.EndObject();
}
}

void WriteProperties(
  JsonWriter& json, const FilterTrio& filters, bool (*isMeant)(const PropertyOption&))
{
  json.Name("properties");
  json.BeginObject();
  for (const PropertyOption& property : SurfaceProperties())
  {
    if (isMeant(property))
    {
      json.Member(property.Property, property.Get(filters));
    }
  }
  json.EndObject();
}

void WriteMemory(JsonWriter& json, double reader, const std::vector<double>& byRank)
{
  json.Name("memory");
  json.BeginObject();
  json.Member("reader", reader);
  json.Member("peak", PeakMemory());
  if (!byRank.empty())
  {
    json.Numbers("peak_by_rank", byRank.data(), static_cast<int>(byRank.size()));
  }
  json.EndObject();
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

void WriteReport(std::ostream& out, const ReportInput& input)
{
  vtkDeformableSurface* filter = input.Filters.Surface;
  vtkPolyData* surface = filter->GetOutput();
  JsonWriter json(out);
  json.BeginObject();
  WriteInput(json, input.VolumeName, input.Volume);
  json.Member("iso_value", filter->GetIsoValue());
  json.Member("finished", input.IsFinished);
  WriteSurfaceFacts(json, surface, input.Size);
  WriteComponents(json, surface);
  WriteLevels(json, input);
  WriteSeconds(json, input);
  WriteMemory(json, input.ReaderMemory, input.PeaksByRank);
  WriteProperties(json, input.Filters,
    [](const PropertyOption& property) { return !IsOfLabelsOnly(property); });
  WriteEnd(json, input.Warnings);
  json.EndObject();
}

void WriteEnd(JsonWriter& json, const std::vector<std::string>& warnings)
{
  json.Name("warnings");
  json.BeginArray();
  for (const std::string& warning : warnings)
  {
    json.Value(warning);
  }
  json.EndArray();
  json.Name("versions");
  json.BeginObject();
  json.Member("volumic", VOLUMIC_VERSION);
  json.Member("vtk", vtkVersion::GetVTKVersion());
  json.EndObject();
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Json.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkLabelsToSurfaces.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>
#include <vtkVersion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <ostream>

#include <sys/resource.h>

namespace tool
{
double PeakMemory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string TextOf(const Solid& solid)
{
  const auto tenths = [](double angle) { return NumberText(std::round(10.0 * angle) / 10.0); };
  return std::to_string(solid.Grid->GetNumberOfCells()) + " tetrahedra by " + solid.Mesher +
    "; the least angle between two faces is " + tenths(solid.LeastAngle) +
    " degrees, of 1 % it is under " + tenths(solid.PercentAngle);
}

namespace
{
/** The member `input`: what the volume is. */
Json InputFacts(const std::string& name, const VolumeFacts& volume)
{
  Json facts = { { "name", name }, { "dimensions", volume.Size() },
    { "spacing", AsJsonArray(volume.Spacing) }, { "origin", AsJsonArray(volume.Origin) },
    { "space", volume.World.Axes }, { "unit", volume.World.Unit },
    { "file_space", volume.World.FileAxes }, { "file_unit", volume.World.FileUnit },
    { "scale", volume.World.Scale }, { "scalar_type", vtkImageScalarTypeNameMacro(volume.Type) },
    { "range", AsJsonArray(volume.Range) } };
  if (!volume.Resampling.empty())
  {
    facts["resampling"] = volume.Resampling;
  }
  return facts;
}

/** Members of the size and shape of a surface, from its field data. */
void AddSurfaceFacts(Json& json, vtkPolyData* surface, const SurfaceSize& size)
{
  static const char* const facts[][2] = { { "components", "NumberOfComponents" },
    { "genus", "Genus" }, { "euler_characteristic", "EulerCharacteristic" }, { "area", "Area" },
    { "volume", "Volume" }, { "delta", "Delta" }, { "unit", "Unit" }, { "level", "Level" },
    { "iterations", "Iterations" }, { "lost_parts", "LostParts" },
    { "recovered_parts", "RecoveredParts" }, { "lost_cavities", "LostCavities" },
    { "recovered_cavities", "RecoveredCavities" }, { "missing_parts", "MissingParts" },
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

/** The member `component_features`: an object per component, the one of the largest area first. */
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
        component[name] =
          count == 1 ? AsJson(*tuple) : AsJsonArray(std::vector<double>(tuple, tuple + count));
      }
    }
  }
  return components;
}

/** The member `solid`, if there is one. */
void AddSolid(Json& json, const Solid& solid)
{
  if (!solid.Grid)
  {
    return;
  }
  Json regions = Json::array();
  for (const auto& [label, region] : solid.Regions)
  {
    regions.push_back({ { "label", label }, { "name", EntryOr(solid.Names, label, "") },
      { "tetrahedra", region.Tetrahedra }, { "volume", AsJson(region.Volume) } });
  }
  json["solid"] = { { "mesher", solid.Mesher }, { "nodes", solid.Grid->GetNumberOfPoints() },
    { "tetrahedra", solid.Grid->GetNumberOfCells() }, { "least_angle", solid.LeastAngle },
    { "percent_angle", solid.PercentAngle }, { "regions", regions } };
}

/** The member `properties`: those that are meant, with their values. */
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

/** The member `memory`. @param reader PeakMemory() when the volume had been read */
Json MemoryFacts(double reader)
{
  return { { "reader", reader }, { "peak", PeakMemory() } };
}

/** The report with the members `warnings` and `versions` at its end, as text. */
std::string EndedReport(Json& json, const std::vector<std::string>& warnings)
{
  json["warnings"] = warnings;
  json["versions"] = { { "volumic", VOLUMIC_VERSION }, { "vtk", vtkVersion::GetVTKVersion() } };
  return TextOf(json);
}

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

std::string ReportText(const ReportInput& input)
{
  vtkDeformableSurface* filter = input.Filters.Surface;
  vtkPolyData* surface = filter->GetOutput();
  Json json = { { "input", InputFacts(input.VolumeName, input.Volume) },
    { "iso_value", AsJson(filter->GetIsoValue()) },
    { "upper_value", AsJson(filter->GetUpperValue()) }, { "finished", input.IsFinished } };
  AddSurfaceFacts(json, surface, input.Size);
  json["component_features"] = ComponentFeatures(surface);
  AddSolid(json, input.Filling);
  json["levels"] = LevelFacts(input);
  json["seconds"] = SecondsOf(input);
  json["memory"] = MemoryFacts(input.ReaderMemory);
  json["properties"] = PropertyValues(
    input.Filters, [](const PropertyOption& property) { return !IsOfLabelsOnly(property); });
  return EndedReport(json, input.Warnings);
}

// ---- Labels -------------------------------------------------------------------------------------

vtkIdType WrongVoxels(vtkPolyData* surface, const char* name)
{
  vtkDataArray* wrong = surface->GetFieldData()->GetArray(name);
  return wrong && wrong->GetNumberOfTuples() > 0 ? static_cast<vtkIdType>(wrong->GetComponent(0, 0))
                                                 : 0;
}

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

/** `worst_angle`, `worst_angle_position` and `small_contacts`, of interfaces with lines. */
void AddLineFacts(Json& json, vtkPolyData* interfaces)
{
  if (vtkDataArray* angle = interfaces->GetFieldData()->GetArray("WorstAngle"))
  {
    vtkFieldData* told = interfaces->GetFieldData();
    const double* place = told->GetArray("WorstAnglePosition")->GetTuple(0);
    json["small_contacts"] = static_cast<int>(told->GetArray("SmallContacts")->GetComponent(0, 0));
    json["worst_angle"] = angle->GetComponent(0, 0);
    json["worst_angle_position"] = AsJsonArray(std::vector<double>(place, place + 3));
  }
}
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
    if (vtkDataArray* error = surface->GetFieldData()->GetArray("VolumeError"))
    {
      facts["volume_error"] = error->GetComponent(0, 0);
    }
    facts["missed_voxels"] = WrongVoxels(surface, "MissedVoxels");
    AddSurfaceFacts(facts, surface, { surface->GetNumberOfPoints(), surface->GetNumberOfPolys() });
    facts["component_features"] = ComponentFeatures(surface);
  }
  AddLineFacts(json, report.Filters.Labels->GetInterfaces());
  AddSolid(json, report.Filling);
  json["seconds"] = { { "surface", report.Seconds } };
  json["memory"] = MemoryFacts(report.ReaderMemory);
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
      { "color", AsJsonArray(label.Color) }, { "layer", label.Layer }, { "voxels", label.Voxels },
      { "volume", AsJson(VolumeOf(label, list.Volume)) }, { "box", label.Box } });
  }
  return EndedReport(json, list.Warnings);
}
}

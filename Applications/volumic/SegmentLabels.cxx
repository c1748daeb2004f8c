// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Segment.h"

#include "LabelMap.h"
#include "LabelNames.h"
#include "ProbeVolumes.h"
#include "Ranks.h"
#include "Report.h"
#include "RunFilter.h"
#include "SurfaceProperties.h"
#include "Texts.h"
#include "ToolOptions.h"
#include "WriteOutputs.h"
#include "WriteResults.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkInformation.h>
#include <vtkLabelTable.h>
#include <vtkLabelsToSurfaces.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <utility>

namespace tool
{
namespace
{
/** What a layer has of the time limit, seconds, where the others have used it up. */
constexpr double LeastTime = 1e-3;

/** Have a filter work on the labels of a layer. */
void SetInput(vtkAlgorithm* filter, const LabelMap& map, int layer)
{
  filter->SetInputDataObject(0, map.Layers[static_cast<std::size_t>(layer)]);
  filter->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

/** @param warnings those of the filter, which are told, go here */
std::vector<KnownLabel> KnownLabels(const ToolOptions& options, const LabelMap& map,
  const Announcer& announcer, std::vector<std::string>& warnings)
{
  std::vector<KnownLabel> known;
  for (int layer = 0; layer < static_cast<int>(map.Layers.size()); ++layer)
  {
    vtkNew<vtkLabelTable> table;
    SetInput(table, map, layer);
    try
    {
      const FilterRun run = RunFilter(table, "Looking for labels", ProgressStyle::None);
      for (const std::string& warning : run.Warnings)
      {
        announcer.Say("warning: " + options.Volume + ": " + warning);
        warnings.push_back(warning);
      }
      const std::vector<KnownLabel> more = LabelsOf(table->GetOutput(), layer);
      known.insert(known.end(), more.begin(), more.end());
    }
    catch (const Failure& failure)
    {
      // A few of very many labels can be chosen by their numbers, but not told of.
      const std::vector<KnownLabel> some =
        NumberedLabels(options.Labels, GetLabelNames(map.Layers[static_cast<std::size_t>(layer)]));
      FailIf(some.empty() || map.Layers.size() > 1 || options.ListsLabels,
        options.Volume + ": " + failure.what());
      return some;
    }
  }
  return known;
}

vtkSmartPointer<vtkPolyData> NoSurface(const std::string& reason)
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkStringArray> text;
  text->SetName("StopReason");
  text->InsertNextValue(reason);
  surface->GetFieldData()->AddArray(text);
  return surface;
}

/** The surfaces that are wanted, none of which is there yet. */
std::vector<LabelSurface> PlanSurfaces(
  const ToolOptions& options, const std::vector<KnownLabel>& known, vtkLabelsToSurfaces* filter)
{
  const std::vector<std::string> fileNames = FileNamesOf(known);
  std::vector<LabelSurface> surfaces;
  const std::vector<std::size_t> chosen = Named(options.Volume,
    [&] { return ChooseLabels(options.Labels, known, filter->GetBackgroundLabel()); });
  FailIf(chosen.empty(),
    options.Volume + ": it has no label but the background, " +
      std::to_string(filter->GetBackgroundLabel()) + "; choose another one with --background");
  for (const std::size_t i : chosen)
  {
    if (!filter->GetMerge() || surfaces.empty())
    {
      surfaces.push_back({ { known[i] }, known[i].Name, fileNames[i], NoSurface("cancelled"), {} });
      continue;
    }
    LabelSurface& merged = surfaces.front();
    FailIf(merged.Labels.front().Layer != known[i].Layer,
      "--merge: the labels lie in several layers of the file, of which those of one "
      "can be merged; choose it with --component");
    merged.Labels.push_back(known[i]);
  }
  return surfaces;
}

/**
 * Have the filter work on the labels of a layer, on all ranks; its blocks take the place of what is
 * planned.
 */
FilterRun RunOnLayer(const ToolOptions& options, const LabelMap& map, int layer,
  vtkLabelsToSurfaces* filter, std::vector<LabelSurface>& surfaces, ProgressStyle style,
  Ranks& ranks)
{
  std::vector<LabelSurface*> own; // by their labels, as the blocks
  filter->ClearLabels();
  for (LabelSurface& surface : surfaces)
  {
    if (surface.Labels.front().Layer == layer)
    {
      own.push_back(&surface);
      for (const KnownLabel& label : surface.Labels)
      {
        filter->AddLabel(label.Label);
      }
    }
  }
  if (own.empty() || WasInterrupted())
  {
    return FilterRun();
  }
  SetInput(filter, map, layer);
  FilterRun run =
    Named(options.Volume, [&] { return RunFilter(filter, "Making surfaces", style, &ranks); });
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  auto* lost = vtkStringArray::SafeDownCast(blocks->GetFieldData()->GetAbstractArray("LostLabels"));
  const std::string told = lost ? InWordsOfOptions(lost->GetValue(0)) : std::string();
  // Where it is much, it is a warning of the filter's already.
  if (lost &&
    std::none_of(run.Warnings.begin(), run.Warnings.end(),
      [&told](const std::string& warning) { return warning.find(told) != std::string::npos; }))
  {
    run.Warnings.push_back(told);
  }
  for (unsigned int i = 0; i < own.size() && i < blocks->GetNumberOfBlocks(); ++i)
  {
    own[i]->Seconds = filter->GetSeconds(static_cast<int>(i));
    own[i]->Surface = vtkPolyData::SafeDownCast(blocks->GetBlock(i));
    const char* name = blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
    own[i]->Name = name ? name : own[i]->Name;
  }
  return run;
}

/** Make all surfaces, by all ranks. @param report given times and warnings */
void MakeSurfaces(const ToolOptions& options, const LabelMap& map, vtkLabelsToSurfaces* filter,
  std::vector<LabelSurface>& surfaces, const Announcer& announcer, LabelReport& report,
  Ranks& ranks)
{
  const double limit = filter->GetTimeLimit();
  for (int layer = 0; layer < static_cast<int>(map.Layers.size()); ++layer)
  {
    if (limit > 0.0)
    {
      filter->SetTimeLimit(std::max(limit - report.Seconds, LeastTime));
    }
    const FilterRun run = RunOnLayer(options, map, layer, filter, surfaces, announcer.Style, ranks);
    report.Seconds += run.Seconds;
    for (const std::string& warning : run.Warnings)
    {
      announcer.Say("warning: " + warning);
      report.Warnings.push_back(warning);
    }
  }
  report.IsFinished = std::none_of(surfaces.begin(), surfaces.end(),
    [](const LabelSurface& surface) { return surface.IsUnfinished(); });
}

/** Of a run that was stopped. */
std::string NothingBefore(const std::vector<LabelSurface>& surfaces)
{
  const bool isLate = std::any_of(surfaces.begin(), surfaces.end(),
    [](const LabelSurface& surface) { return StopReason(surface.Surface) == "time limit"; });
  return isLate ? "the time limit came before there was a surface; nothing is written"
                : "interrupted before there was a surface; nothing is written";
}

void CheckThatAnyIsThere(const ToolOptions& options, const LabelReport& report)
{
  const bool isThere = std::any_of(report.Surfaces.begin(), report.Surfaces.end(),
    [](const LabelSurface& surface) { return surface.Surface->GetNumberOfPoints() > 0; });
  FailIf(!isThere,
    report.IsFinished ? options.Volume +
        ": none of the labels has a surface; smaller triangles may hold them "
        "(--finest, --edge-length)"
                      : NothingBefore(report.Surfaces));
}

/** Write surfaces and report. @throws Failure if not all could be written. */
void WriteAll(const ToolOptions& options, std::vector<LabelSurface>& surfaces, LabelReport& report,
  ProgressStyle style)
{
  for (LabelSurface& surface : surfaces)
  {
    MarkSpace(surface.Surface, report.Volume.World);
  }
  MarkSpace(report.Filters.Labels->GetInterfaces(), report.Volume.World);
  Failures failures;
  SolidMaker solids(options.Solids, WasInterrupted);
  WriteLabelSurfaces(
    options, surfaces, report.Filters.Labels->GetInterfaces(), solids, style, failures);
  report.Filling = SharesInterfaces(options) ? solids.Last() : Solid();
  if (!options.Report.empty())
  {
    failures.Try([&] { WriteText(ReportText(report), options.Report); });
  }
  failures.Throw();
}

void TellEnd(const std::vector<LabelSurface>& surfaces, const Announcer& announcer)
{
  vtkIdType vertices = 0;
  vtkIdType wrong = 0;
  std::size_t count = 0;
  std::string unfinished;
  std::string missing;
  std::string reason;
  for (const LabelSurface& surface : surfaces)
  {
    const vtkIdType points = surface.Surface->GetNumberOfPoints();
    vertices += points;
    wrong += WrongVoxels(surface.Surface);
    count += points > 0 ? 1 : 0;
    std::string& list = points > 0 ? unfinished : missing;
    list += surface.IsUnfinished() ? (list.empty() ? "" : ", ") + surface.Name : "";
    reason = surface.IsUnfinished() ? StopReason(surface.Surface) : reason;
  }
  announcer.Say(std::to_string(count) + (count == 1 ? " surface, " : " surfaces, ") +
    std::to_string(vertices) + " vertices" +
    (wrong > 0 ? "; " + std::to_string(wrong) + " voxel centres are on the wrong side" : ""));
  if (!unfinished.empty() || !missing.empty())
  {
    std::cerr << "volumic: unfinished (" << reason << "); what is finished was written"
              << (missing.empty() ? "" : "; there is no surface of " + missing)
              << (unfinished.empty() ? "" : "; as they were then, those of " + unfinished) << "\n";
  }
}

/** The volume, with its names. @param known the labels in it */
void Announce(const ToolOptions& options, const LabelMap& map, const std::vector<KnownLabel>& known,
  int background, const Announcer& announcer)
{
  const auto count = std::count_if(known.begin(), known.end(),
    [background](const KnownLabel& label) { return label.Label != background; });
  const std::array<int, 3> size = map.Facts.Size();
  const std::size_t layers = map.Layers.size();
  announcer.Say(options.Volume + ": " + NumberText(size[0]) + " x " + NumberText(size[1]) + " x " +
    NumberText(size[2]) + " voxels, " + vtkImageScalarTypeNameMacro(map.Facts.Type) + ", " +
    std::to_string(count) + (count == 1 ? " label" : " labels") +
    (layers > 1 ? " in " + std::to_string(layers) + " layers" : "") + map.Facts.World.Text());
}

/** The labels that are chosen, as --list-labels has them. */
void ListLabels(const ToolOptions& options, const LabelMap& map,
  const std::vector<KnownLabel>& known, int background, std::vector<std::string> warnings)
{
  LabelList list{ std::filesystem::path(options.Volume).filename().string(), map.Facts,
    static_cast<int>(map.Layers.size()) };
  list.Warnings = std::move(warnings);
  const std::vector<std::size_t> chosen =
    Named(options.Volume, [&] { return ChooseLabels(options.Labels, known, background); });
  for (const std::size_t i : chosen)
  {
    list.Labels.push_back(known[i]);
  }
  if (!options.Report.empty())
  {
    WriteText(ReportText(list), options.Report);
  }
  if (options.Report != "-")
  {
    WriteTable(std::cout, list);
  }
}
/**
 * Read the label map, and do of what the options ask for what needs no surface.
 * @return the surfaces that they ask for, none of which is there yet
 */
std::vector<LabelSurface> Prepare(const ToolOptions& options, const FilterTrio& filters,
  vtkImagePyramid* holder, const Announcer& announcer, LabelMap& map, MadeFolders& folders,
  LabelReport& report)
{
  CheckFiles(options);
  map = LoadLabelMap(options, filters.Surface, holder, announcer);
  report.Volume = map.Facts;
  report.ReaderMemory = PeakMemory();
  if (!options.WrittenVolume.empty())
  {
    WriteVolume(map.Image, options.WrittenVolume, announcer.Style);
  }
  if (!options.WantsSurface())
  {
    return {};
  }
  const int background = filters.Labels->GetBackgroundLabel();
  std::vector<std::string> warnings;
  const std::vector<KnownLabel> known = KnownLabels(options, map, announcer, warnings);
  Announce(options, map, known, background, announcer);
  if (options.ListsLabels)
  {
    ListLabels(options, map, known, background, std::move(warnings));
    return {};
  }
  std::vector<LabelSurface> surfaces = PlanSurfaces(options, known, filters.Labels);
  CheckLabelSurfaces(options, surfaces, folders);
  return surfaces;
}
}

ExitCode SegmentLabels(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks)
{
  const Announcer announcer(options);
  ShareProperties(filters);
  filters.Labels->SetSharedInterfaces(SharesInterfaces(options));
  const vtkNew<vtkImagePyramid> holder; // of the scratch memory of the volume
  LabelMap map;
  MadeFolders folders;
  std::vector<LabelSurface> surfaces;
  LabelReport report{ std::filesystem::path(options.Volume).filename().string(), {}, filters,
    surfaces };
  surfaces = Prepare(options, filters, holder, announcer, map, folders, report);
  if (surfaces.empty())
  {
    return Success;
  }
  const ProbeVolumes probes(options, announcer);
  CatchInterrupts();
  MakeSurfaces(options, map, filters.Labels, surfaces, announcer, report, ranks);
  CheckThatAnyIsThere(options, report);
  for (LabelSurface& surface : surfaces)
  {
    std::vector<std::string> warnings;
    surface.Surface = WithEnds(surface.Surface, map.Image, options.Ends, warnings);
    for (const std::string& warning : warnings)
    {
      announcer.Say("warning: " + surface.Name + ": " + warning);
      report.Warnings.push_back(surface.Name + ": " + warning);
    }
    probes.AddTo(surface.Surface);
  }
  probes.AddTo(filters.Labels->GetInterfaces());
  announcer.Follow("", [&] { WriteAll(options, surfaces, report, announcer.Style); });
  TellEnd(surfaces, announcer);
  std::vector<vtkPolyData*> printed;
  for (const LabelSurface& surface : surfaces)
  {
    printed.push_back(surface.Surface);
  }
  announcer.Say(TextOfPrint(options, printed, report.Volume.World));
  if (report.Filling.Grid)
  {
    announcer.Say(TextOf(report.Filling));
  }
  return report.IsFinished ? Success : Unfinished;
}

int HelpWithLabels(const ToolOptions& options, const FilterTrio& filters, Ranks& ranks)
{
  ShareProperties(filters);
  filters.Labels->SetSharedInterfaces(SharesInterfaces(options));
  filters.Labels->SetInputDataObject(0, vtkNew<vtkImageData>());
  return ranks.Wait(WasInterrupted,
    [&]
    {
      filters.Labels->Modified();
      try
      {
        RunFilter(filters.Labels, "", ProgressStyle::None, &ranks);
      }
      catch (const Failure&)
      {
        // The first rank has it as well, and tells it.
      }
    });
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ToolOptions.h"

#include "ToolErrors.h"
#include "WriteOutputs.h"
#include "WriteResults.h"

#include <algorithm>
#include <iterator>

namespace tool
{
namespace
{
using Options = std::vector<const char*>;

/** Options of which one is given, and others that make no sense with it. */
const std::pair<const char*, Options> Exclusions[] = {
  { "edges", { "region", "region-box", "resample", "isotropic" } },
  { "memory", { "region", "region-box", "resample", "isotropic" } },
  { "region", { "region-box" } },
  { "resample", { "isotropic" } },
  { "scale", { "unit" } },
  { "seeds", { "initial-surface" } },
  { "seed-position", { "initial-surface" } },
  { "triangles", { "tolerance", "resume", "time-limit" } },
};

/** Surfaces of labels have no evolution to choose and look at. */
const Options WithoutLabels = { "seeds", "seed-position", "initial-surface", "attracting-points",
  "attracting-position", "edges", "triangles", "history", "levels-output", "snapshots" };

/** Options that need another one. */
const std::pair<const char*, const char*> Needs[] = {
  { "edge-attraction", "edges" },
  { "probe-depth", "probe" },
};

void Exclude(const ToolOptions& options, const std::string& option, const Options& others)
{
  for (const char* other : others)
  {
    FailIf<UsageError>(options.Has(option) && options.Has(other),
      "--" + option + " and --" + other + " exclude each other");
  }
}

/** What means nothing unless there are labels. */
void CheckWithoutLabels(const ToolOptions& options)
{
  for (const auto& [property, text] : options.Properties)
  {
    FailIf<UsageError>(IsOfLabelsOnly(*property), "--" + property->Option + " needs --labels");
  }
  FailIf<UsageError>(!options.Format.empty(), "--format needs --labels");
  FailIf<UsageError>(!options.NamesOfLabels.empty() && options.WrittenVolume.empty(),
    "--label-names needs --labels, or --write-volume");
}

/** Whether the property means something where labels are only listed. */
bool IsOfList(const PropertyOption& property)
{
  static const std::string needed[] = { "SelectedComponent", "BackgroundLabel", "NumberOfThreads",
    "MemoryLimit", "ScratchDirectory" };
  return std::find(std::begin(needed), std::end(needed), property.Property) != std::end(needed);
}

/** What makes no sense for surfaces of labels, or for a list of labels. */
void CheckWithLabels(const ToolOptions& options)
{
  const std::string asked = options.ListsLabels ? "list-labels" : "labels";
  if (options.ListsLabels && !options.Surfaces.empty())
  {
    throw UsageError(options.Surfaces.front() +
      ": --list-labels makes no surfaces; leave out the file or the option");
  }
  for (const char* other : WithoutLabels)
  {
    Exclude(options, other, { asked.c_str() });
  }
  Exclude(options, "format", { "list-labels" });
  for (const auto& [property, text] : options.Properties)
  {
    FailIf<UsageError>(!(options.ListsLabels ? IsOfList(*property) : IsOfLabels(*property)),
      "--" + property->Option + " and --" + asked + " exclude each other");
    FailIf<UsageError>(
      property->Property == "KeepComponents" && (text == "at-points" || text == "not-at-seeds"),
      "--keep " + text + " and --labels exclude each other");
  }
  if (SharesInterfaces(options))
  {
    FailIf<UsageError>(options.Has("probe-depth"),
      "--probe-depth and shared interfaces, which have no normals, exclude each other");
    FailIf<UsageError>(options.Has("ends"), "--ends and shared interfaces exclude each other");
  }
  bool hasFolder = false;
  for (const std::string& name : options.Surfaces)
  {
    CheckLabelOutput(options, name);
    hasFolder = hasFolder || OutputOf(options, name) == LabelOutput::Folder;
  }
  FailIf<UsageError>(!options.Format.empty() && !hasFolder,
    "--format is that of the files in a folder: give one to write to");
}

void CheckSolids(const ToolOptions& options)
{
  FailIf<UsageError>(options.Has("mesher") && !MakesSolids(options),
    "--mesher needs a file of tetrahedra: .vtu, .inp or .msh");
  FailIf<UsageError>(options.Has("maximum-volume") && !MakesSolids(options),
    "--maximum-volume needs a file of tetrahedra: .vtu, .inp, or .msh with --mesher");
  FailIf<UsageError>(options.Ends == Ends::Open &&
      std::any_of(options.Surfaces.begin(), options.Surfaces.end(), IsOfSolids),
    "--ends open and files of solids, which are closed, exclude each other");
}
}

void CheckOptions(const ToolOptions& options)
{
  const bool isSegmented = options.Task == ToolOptions::Task::Segment;
  if (!isSegmented && options.Task != ToolOptions::Task::ListFiles &&
    options.Task != ToolOptions::Task::ListSeries)
  {
    return;
  }
  FailIf<UsageError>(options.Volume.empty(), "no volume is given");
  if (!isSegmented)
  {
    return;
  }
  FailIf<UsageError>(
    !options.WantsSurface() && options.WrittenVolume.empty(), "no file to write is given");
  options.Labels.empty() ? CheckWithoutLabels(options) : CheckWithLabels(options);
  for (const auto& [option, others] : Exclusions)
  {
    Exclude(options, option, others);
  }
  for (const auto& [option, needed] : Needs)
  {
    FailIf<UsageError>(options.Has(option) && !options.Has(needed),
      std::string("--") + option + " needs --" + needed);
  }
  CheckSolids(options);
}
}

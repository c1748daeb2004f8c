// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ToolOptions.h"

#include "ToolErrors.h"
#include "WriteOutputs.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace tool
{
namespace
{
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

/**
 * What makes no sense for surfaces of labels, which have no evolution to choose and look at, or for
 * a list of labels.
 */
void CheckWithLabels(const ToolOptions& options)
{
  const std::string asked = options.ListsLabels ? "--list-labels" : "--labels";
  if (options.ListsLabels && !options.Surfaces.empty())
  {
    throw UsageError(options.Surfaces.front() +
      ": --list-labels makes no surfaces; leave out the file or the option");
  }
  const std::pair<const char*, bool> others[] = { { "seeds", !options.Seeds.empty() },
    { "seed-position", !options.SeedPositions.empty() },
    { "initial-surface", !options.InitialSurface.empty() },
    { "attracting-points", !options.AttractingPoints.empty() },
    { "attracting-position", !options.AttractingPositions.empty() },
    { "edges", !options.Edges.empty() }, { "history", !options.History.empty() },
    { "levels-output", !options.Levels.empty() }, { "snapshots", !options.Snapshots.empty() },
    { "format", options.ListsLabels && !options.Format.empty() } };
  for (const auto& [option, isGiven] : others)
  {
    FailIf<UsageError>(
      isGiven, "--" + std::string(option) + " and " + asked + " exclude each other");
  }
  for (const auto& [property, text] : options.Properties)
  {
    FailIf<UsageError>(!(options.ListsLabels ? IsOfList(*property) : IsOfLabels(*property)),
      "--" + property->Option + " and " + asked + " exclude each other");
    if (property->Property == "KeepComponents" && (text == "at-points" || text == "not-at-seeds"))
    {
      throw UsageError("--keep " + text + " and --labels exclude each other");
    }
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
}

void CheckOptions(const ToolOptions& options)
{
  if (options.Task != ToolOptions::Task::Segment && options.Task != ToolOptions::Task::ListFiles)
  {
    return;
  }
  FailIf<UsageError>(options.Volume.empty(), "no volume is given");
  if (options.Task == ToolOptions::Task::ListFiles)
  {
    return;
  }
  FailIf<UsageError>(
    !options.WantsSurface() && options.WrittenVolume.empty(), "no file to write is given");
  if (options.Labels.empty())
  {
    CheckWithoutLabels(options);
  }
  else
  {
    CheckWithLabels(options);
  }
  FailIf<UsageError>(options.Edges.empty() && options.HasProperty("EdgeAttractionWeight"),
    "--edge-attraction needs --edges");
  FailIf<UsageError>(!options.Seeds.empty() && !options.InitialSurface.empty(),
    "--seeds and --initial-surface exclude each other");
  FailIf<UsageError>(!options.SeedPositions.empty() && !options.InitialSurface.empty(),
    "--seed-position and --initial-surface exclude each other");
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CheckOptions.h"

#include "LabelOutputs.h"
#include "ToolErrors.h"
#include "ToolOptions.h"

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
    if (IsOfLabelsOnly(*property))
    {
      throw UsageError("--" + property->Option + " needs --labels");
    }
  }
  if (!options.Format.empty())
  {
    throw UsageError("--format needs --labels");
  }
  if (!options.NamesOfLabels.empty() && options.WrittenVolume.empty())
  {
    throw UsageError("--label-names needs --labels, or --write-volume");
  }
}

/** What makes no sense for surfaces of labels, which have no evolution to choose and look at. */
void CheckWithLabels(const ToolOptions& options)
{
  const std::pair<const char*, bool> others[] = { { "seeds", !options.Seeds.empty() },
    { "seed-position", !options.SeedPositions.empty() },
    { "initial-surface", !options.InitialSurface.empty() },
    { "attracting-points", !options.AttractingPoints.empty() },
    { "attracting-position", !options.AttractingPositions.empty() },
    { "edges", !options.Edges.empty() }, { "history", !options.History.empty() },
    { "levels-output", !options.Levels.empty() }, { "snapshots", !options.Snapshots.empty() } };
  for (const auto& [option, isGiven] : others)
  {
    if (isGiven)
    {
      throw UsageError("--" + std::string(option) + " and --labels exclude each other");
    }
  }
  for (const auto& [property, text] : options.Properties)
  {
    if (!IsOfLabels(*property))
    {
      throw UsageError("--" + property->Option + " and --labels exclude each other");
    }
    if (property->Property == "KeepComponents" && text == "at-points")
    {
      throw UsageError("--keep at-points and --labels exclude each other");
    }
  }
  bool hasFolder = false;
  for (const std::string& name : options.Surfaces)
  {
    CheckLabelOutput(options, name);
    hasFolder = hasFolder || OutputOf(name) == LabelOutput::Folder;
  }
  if (!options.Format.empty() && !hasFolder)
  {
    throw UsageError("--format is that of the files in a folder: give one to write to");
  }
}
}

void CheckOptions(const ToolOptions& options)
{
  if (options.Task != ToolOptions::Task::Segment && options.Task != ToolOptions::Task::ListFiles)
  {
    return;
  }
  if (options.Volume.empty())
  {
    throw UsageError("no volume is given");
  }
  if (options.Task == ToolOptions::Task::ListFiles)
  {
    return;
  }
  if (!options.WantsSurface() && options.WrittenVolume.empty())
  {
    throw UsageError("no file to write is given");
  }
  if (options.Labels.empty())
  {
    CheckWithoutLabels(options);
  }
  else
  {
    CheckWithLabels(options);
  }
  if (options.Edges.empty() && options.HasProperty("EdgeAttractionWeight"))
  {
    throw UsageError("--edge-attraction needs --edges");
  }
  if (!options.Seeds.empty() && !options.InitialSurface.empty())
  {
    throw UsageError("--seeds and --initial-surface exclude each other");
  }
  if (!options.SeedPositions.empty() && !options.InitialSurface.empty())
  {
    throw UsageError("--seed-position and --initial-surface exclude each other");
  }
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteOutputs.h"

#include "GatherSurface.h"
#include "LoadInputs.h"
#include "OutputFiles.h"
#include "Ranks.h"
#include "Report.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "WriteResults.h"

#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tool
{
namespace
{
/** Whether the surfaces go into one .vtm rather than into a folder. */
bool IsBlocks(const std::string& name)
{
  return std::filesystem::path(name).extension() == ".vtm";
}

/** The last block of the levels may be level -1. */
int LevelOf(vtkPolyData* surface)
{
  return static_cast<int>(surface->GetFieldData()->GetArray("Level")->GetComponent(0, 0));
}

/** What is written, and how. */
struct Outputs
{
  const ToolOptions& Options;
  const SurfaceWriting& Writing;
  Ranks& All;
  Failures& Failed; ///< The same on all ranks.

  /** By the first rank. */
  void Attempt(const std::function<void()>& write) const
  {
    this->Failed.Try([&] { this->All.OnFirst(write); });
  }
};

/** @param part of the surface, that this rank has */
void WriteSurfaces(const Outputs& to, vtkPolyData* part)
{
  vtkSmartPointer<vtkPolyData> whole;
  bool isGathered = false;
  for (const std::string& name : to.Options.Surfaces)
  {
    if (HasPieces(name) && !to.All.IsOne())
    {
      to.Failed.Try([&] { WriteSurfaceOfRanks(part, name, to.Writing, to.All); });
      continue;
    }
    if (!std::exchange(isGathered, true))
    {
      whole = GatherSurface(to.All, part);
    }
    to.Attempt([&] { WriteSurface(whole, name, to.Writing); });
  }
}

/** @param blocks of which this rank has parts */
void WriteSeveral(const Outputs& to, vtkMultiBlockDataSet* blocks, const std::string& name,
  const std::string& prefix, int (*numbers)(vtkPolyData*))
{
  if (name.empty())
  {
    return;
  }
  const vtkSmartPointer<vtkMultiBlockDataSet> whole = GatherBlocks(to.All, blocks);
  to.Attempt(
    [&]
    {
      IsBlocks(name) ? WriteBlocks(whole, name, to.Writing.Style)
                     : WriteFolder(whole, name, prefix, to.Writing.Style, numbers);
    });
}
}

void CheckFiles(const ToolOptions& options)
{
  std::vector<OutputName> outputs;
  for (const std::string& name : options.Surfaces)
  {
    CheckSurfaceName(name);
    outputs.push_back(
      { name, HasPieces(name) ? OutputName::Kind::Blocks : OutputName::Kind::File, "" });
  }
  for (const auto& [name, prefix] :
    { std::pair{ options.Levels, "level" }, std::pair{ options.Snapshots, "snapshot" } })
  {
    outputs.push_back(
      { name, IsBlocks(name) ? OutputName::Kind::Blocks : OutputName::Kind::Folder, prefix });
  }
  if (!options.WrittenVolume.empty())
  {
    CheckVolumeName(options.WrittenVolume);
  }
  outputs.push_back({ options.WrittenVolume, OutputName::Kind::File, "" });
  outputs.push_back({ options.History, OutputName::Kind::File, "" });
  outputs.push_back({ options.Report == "-" ? "" : options.Report, OutputName::Kind::File, "" });
  outputs.erase(std::remove_if(outputs.begin(), outputs.end(),
                  [](const OutputName& output) { return output.Name.empty(); }),
    outputs.end());

  CheckOutputs(outputs, InputsOf(options));
}

void WriteOutputs(
  const ToolOptions& options, ReportInput& results, ProgressStyle style, Ranks& ranks)
{
  vtkDeformableSurface* filter = results.Filters.Surface;
  const SurfaceWriting writing = { std::string("volumic " VOLUMIC_VERSION) +
      (results.IsFinished ? "" : ", UNFINISHED: " + results.StopReason),
    options.PieceSize, style };
  Failures failures;
  const Outputs to{ options, writing, ranks, failures };
  WriteSurfaces(to, filter->GetOutput());
  WriteSeveral(to, filter->GetLevels(), options.Levels, "level", LevelOf);
  WriteSeveral(to, filter->GetSnapshots(), options.Snapshots, "snapshot", nullptr);
  if (!options.History.empty())
  {
    to.Attempt([&] { WriteTable(filter->GetHistory(), options.History); });
  }
  if (!options.Report.empty())
  {
    results.Size = SizeOf(ranks, filter->GetOutput());
    results.LevelSizes = SizesOf(ranks, filter->GetLevels());
    results.PeaksByRank = PeaksByRank(ranks);
    to.Attempt([&] { WriteText(ReportText(results), options.Report); });
  }
  ranks.Together([&] { failures.Throw(); });
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteOutputs.h"

#include "GatherSurface.h"
#include "OutputFiles.h"
#include "Ranks.h"
#include "Report.h"
#include "SurfaceInputs.h"
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

/** Have the first rank write what all ranks have a part of. */
class OutputWriter
{
public:
  OutputWriter(
    const ToolOptions& options, const SurfaceWriting& writing, vtkDeformableSurface* filter,
    Ranks& ranks)
    : Options(options), Writing(writing), Filter(filter), All(ranks)
  {
  }

  void WriteSurfaces();
  void WriteBlocksOf(vtkMultiBlockDataSet* blocks, const std::string& name,
    const std::string& prefix, int (*numbers)(vtkPolyData*));
  void WriteRest(const ReportInput& results);

  /** @throws Failure if not all could be written. */
  void Finish();

private:
  /** By the first rank. */
  template <class Write>
  void Attempt(const Write& write)
  {
    this->Failed.Try([&] { this->All.OnFirst(write); });
  }

  const ToolOptions& Options;
  const SurfaceWriting& Writing;
  vtkDeformableSurface* Filter;
  Ranks& All;
  Failures Failed; ///< The same on all ranks.
};

void OutputWriter::WriteSurfaces()
{
  vtkPolyData* part = this->Filter->GetOutput();
  vtkSmartPointer<vtkPolyData> whole;
  bool isGathered = false;
  for (const std::string& name : this->Options.Surfaces)
  {
    if (HasPieces(name) && !this->All.IsOne())
    {
      this->Failed.Try([&] { WriteSurfaceOfRanks(part, name, this->Writing, this->All); });
      continue;
    }
    if (!std::exchange(isGathered, true))
    {
      whole = GatherSurface(this->All, part);
    }
    this->Attempt([&] { WriteSurface(whole, name, this->Writing); });
  }
}

void OutputWriter::WriteBlocksOf(vtkMultiBlockDataSet* blocks, const std::string& name,
  const std::string& prefix, int (*numbers)(vtkPolyData*))
{
  if (name.empty())
  {
    return;
  }
  const vtkSmartPointer<vtkMultiBlockDataSet> whole = GatherBlocks(this->All, blocks);
  this->Attempt(
    [&]
    {
      if (IsBlocks(name))
      {
        WriteBlocks(whole, name, this->Writing.Style);
      }
      else
      {
        WriteFolder(whole, name, prefix, this->Writing.Style, numbers);
      }
    });
}

void OutputWriter::WriteRest(const ReportInput& results)
{
  if (!this->Options.History.empty())
  {
    this->Attempt([&] { WriteTable(this->Filter->GetHistory(), this->Options.History); });
  }
  if (!this->Options.Report.empty())
  {
    this->Attempt([&] { WriteText(ReportText(results), this->Options.Report); });
  }
}

void OutputWriter::Finish()
{
  this->All.Together([this] { this->Failed.Throw(); });
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
  OutputWriter writer(options, writing, filter, ranks);
  writer.WriteSurfaces();
  writer.WriteBlocksOf(filter->GetLevels(), options.Levels, "level", LevelOf);
  writer.WriteBlocksOf(filter->GetSnapshots(), options.Snapshots, "snapshot", nullptr);
  if (!options.Report.empty())
  {
    results.Size = SizeOf(ranks, filter->GetOutput());
    results.LevelSizes = SizesOf(ranks, filter->GetLevels());
    results.PeaksByRank = PeaksByRank(ranks);
  }
  writer.WriteRest(results);
  writer.Finish();
}
}

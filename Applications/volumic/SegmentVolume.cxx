// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentVolume.h"

#include "Announcer.h"
#include "InputFiles.h"
#include "LoadVolume.h"
#include "OutputChecks.h"
#include "ParseNumbers.h"
#include "ReadStart.h"
#include "ReadVolume.h"
#include "Report.h"
#include "RunFilter.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "WriteResults.h"

#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkImagePyramid.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOtsuThreshold.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkVolumeToSurface.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <utility>

namespace tool
{
namespace
{
/** Whether the surfaces go into one .vtm rather than into a folder. */
bool IsBlocks(const std::string& name)
{
  return std::filesystem::path(name).extension() == ".vtm";
}

/** All that can be known to be wrong before the work begins. */
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

  std::vector<std::string> inputs = FilesOfVolume(options.Volume);
  for (const std::string& file : FilesOfVolume(options.Edges))
  {
    inputs.push_back(file);
  }
  for (const std::string& file :
    { options.Seeds, options.InitialSurface, options.AttractingPoints })
  {
    inputs.push_back(file);
  }
  CheckOutputs(outputs, inputs);
}

void SetStart(const ToolOptions& options, vtkDeformableSurface* filter)
{
  const bool isChosen = options.HasProperty("Initialization");
  for (const auto& place : options.SeedPositions)
  {
    filter->AddSeedPosition(place[0], place[1], place[2]);
  }
  for (const auto& place : options.AttractingPositions)
  {
    filter->AddAttractingPosition(place[0], place[1], place[2]);
  }
  if (!options.Seeds.empty())
  {
    filter->SetInitialSurfaceData(ReadSeeds(options.Seeds));
  }
  if (!options.Seeds.empty() || !options.SeedPositions.empty())
  {
    if (!isChosen)
    {
      filter->SetInitializationToSeeds();
    }
  }
  else if (!options.InitialSurface.empty())
  {
    filter->SetInitialSurfaceData(ReadSurface(options.InitialSurface));
    if (!isChosen)
    {
      filter->SetInitializationToInputSurface();
    }
  }
  if (!options.AttractingPoints.empty())
  {
    filter->SetAttractingPointsData(ReadAttractingPoints(options.AttractingPoints));
  }
}

/** Hand the map of edges to the filter, as a second array of the volume. */
void SetEdges(const ToolOptions& options, vtkImageData* volume, vtkDeformableSurface* filter,
  vtkImagePyramid* holder, const Announcer& announcer)
{
  if (options.Edges.empty())
  {
    return;
  }
  std::string name = options.Edges;
  vtkPointData* points = volume->GetPointData();
  if (!points->HasArray(name.c_str()))
  {
    const vtkSmartPointer<vtkImageData> edges =
      LoadVoxels(options.Edges, "", filter, holder, announcer).Image;
    if (!std::equal(edges->GetDimensions(), edges->GetDimensions() + 3, volume->GetDimensions()))
    {
      throw Failure(options.Edges + ": its size differs from the volume's");
    }
    name = "Edges";
    while (points->HasArray(name.c_str()))
    {
      name += "_";
    }
    edges->GetPointData()->GetScalars()->SetName(name.c_str());
    points->AddArray(edges->GetPointData()->GetScalars());
  }
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name.c_str());
  if (!options.HasProperty("EdgeAttractionWeight"))
  {
    filter->SetEdgeAttractionWeight(2.0);
  }
}

/** The last block of the levels may be level -1. */
int LevelOf(vtkPolyData* surface)
{
  return static_cast<int>(surface->GetFieldData()->GetArray("Level")->GetComponent(0, 0));
}

/** Run what writes an output. The failure of one must not take the others with it. */
template <class Write>
void Attempt(std::string& failures, const Write& write)
{
  try
  {
    write();
  }
  catch (const Failure& failure)
  {
    failures += (failures.empty() ? "" : "\nvolumic: ") + std::string(failure.what());
  }
}

/** @throws Failure if not all could be written, with a line for each file. */
void WriteOutputs(const ToolOptions& options, const ReportInput& results, ProgressStyle style)
{
  vtkDeformableSurface* filter = results.Filters.Surface;
  const std::string remark = std::string("volumic " VOLUMIC_VERSION) +
    (results.IsFinished ? "" : ", UNFINISHED: " + StopReason(filter->GetOutput()));
  std::string failures;
  for (const std::string& name : options.Surfaces)
  {
    Attempt(failures,
      [&] { WriteSurface(filter->GetOutput(), name, { remark, options.PieceSize, style }); });
  }
  const auto writeSurfaces = [&](vtkMultiBlockDataSet* blocks, const std::string& name,
                               const std::string& prefix, int (*numbers)(vtkPolyData*))
  {
    if (IsBlocks(name))
    {
      WriteBlocks(blocks, name, style);
    }
    else if (!name.empty())
    {
      WriteFolder(blocks, name, prefix, style, numbers);
    }
  };
  Attempt(failures, [&] { writeSurfaces(filter->GetLevels(), options.Levels, "level", LevelOf); });
  Attempt(failures,
    [&] { writeSurfaces(filter->GetSnapshots(), options.Snapshots, "snapshot", nullptr); });
  if (!options.History.empty())
  {
    Attempt(failures, [&] { WriteTable(filter->GetHistory(), options.History); });
  }
  std::ostringstream report;
  WriteReport(report, results);
  if (options.Report == "-")
  {
    std::cout << report.str();
  }
  else if (!options.Report.empty())
  {
    Attempt(failures, [&] { WriteText(report.str(), options.Report); });
  }
  if (!failures.empty())
  {
    throw Failure(failures);
  }
}

/**
 * Run a filter; of too little memory, whoever told of it, is said for which volume and what helps.
 */
FilterRun RunOnVolume(
  const ToolOptions& options, vtkAlgorithm* filter, const std::string& title, ProgressStyle style)
{
  const std::string help =
    "a coarser level (--finest 1), or the volume cropped or resampled, needs less";
  try
  {
    return RunFilter(filter, title, style);
  }
  catch (const std::bad_alloc&)
  {
    throw Failure(options.Volume + ": not enough memory to segment it; " + help);
  }
  catch (const Failure& failure)
  {
    const std::string text = failure.what();
    throw Failure(text.find("memory") == std::string::npos
        ? text
        : options.Volume + ": not enough memory to segment it; " + help);
  }
}

/**
 * Gives the surface's filter its levels: a pyramid that is run here, or, where the length of the
 * edges decides on the pyramid, the volume. @return the run of the pyramid, if there was one.
 */
FilterRun GiveLevels(const ToolOptions& options, vtkImageData* volume, vtkImagePyramid* pyramid,
  vtkDeformableSurface* filter, ProgressStyle style)
{
  if (auto* whole = vtkVolumeToSurface::SafeDownCast(filter))
  {
    whole->SetNumberOfLevels(pyramid->GetNumberOfLevels());
    whole->SetMinimumLevelSize(pyramid->GetMinimumLevelSize());
    whole->SetReductionFactor(pyramid->GetReductionFactor());
    whole->SetInputData(volume);
    return FilterRun();
  }
  pyramid->SetSelectedComponent(filter->GetSelectedComponent());
  pyramid->SetNaNIsBackground(filter->GetNaNIsBackground());
  pyramid->SetNumberOfThreads(filter->GetNumberOfThreads());
  pyramid->SetMemoryLimit(filter->GetMemoryLimit());
  pyramid->SetScratchDirectory(filter->GetScratchDirectory());
  pyramid->SetInputData(volume);
  const FilterRun run = RunOnVolume(options, pyramid, "Building the pyramid", style);
  if (run.IsInterrupted)
  {
    throw Failure("interrupted before there was a surface; nothing is written");
  }
  filter->SetInputConnection(pyramid->GetOutputPort());
  pyramid->ReleaseDataFlagOn(); // The surface lets go of each level as it leaves it.
  return run;
}
}

namespace
{
/** Says, as soon as it is known, where a run with --resume goes on from. */
class ResumeTeller : public vtkCommand
{
public:
  static ResumeTeller* New() { return new ResumeTeller; }

  void Execute(vtkObject* caller, unsigned long, void*) override
  {
    auto* filter = static_cast<vtkDeformableSurface*>(caller);
    const char* text = filter->GetProgressText();
    if (text && std::strncmp(text, "Level", 5) == 0)
    {
      this->Tell(filter);
    }
  }

  void Tell(vtkDeformableSurface* filter)
  {
    if (filter->GetResume() && !std::exchange(this->HasTold, true))
    {
      const int level = filter->GetResumedLevel();
      this->Says->Say(level >= -1
          ? "going on from level " + std::to_string(level) + ", to which a run before has come"
          : "there is no checkpoint to resume from: the run begins anew");
    }
  }

  const Announcer* Says = nullptr;

private:
  bool HasTold = false;
};

/** One that was stopped on its way may go on. */
void RemoveCheckpointOfEnded(vtkDeformableSurface* filter, const std::string& reason)
{
  if (reason != "cancelled" && reason != "time limit")
  {
    filter->RemoveCheckpoint();
  }
}
}

ExitCode SegmentVolume(
  const ToolOptions& options, vtkImagePyramid* pyramid, vtkDeformableSurface* filter)
{
  const Announcer announcer(options);
  CheckFiles(options);
  const vtkNew<vtkImagePyramid> holder; // of the scratch memory of the volume
  const vtkSmartPointer<vtkImageData> volume = LoadVolume(options, filter, holder, announcer);
  const double readerMemory = PeakMemory();
  const int component = filter->GetSelectedComponent();
  if (filter->GetMemoryLimit() > 0)
  {
    filter->SetSelectedComponent(-1); // The volume has no other.
  }
  if (!options.WrittenVolume.empty())
  {
    WriteVolume(volume, options.WrittenVolume, announcer.Style);
  }
  if (!options.WantsSurface())
  {
    return Success;
  }
  SetStart(options, filter);
  const vtkNew<vtkImagePyramid> edgesHolder;
  SetEdges(options, volume, filter, edgesHolder, announcer);
  if (!options.HasProperty("IsoValue"))
  {
    vtkNew<vtkOtsuThreshold> otsu;
    otsu->SetInputData(volume);
    otsu->SetSelectedComponent(filter->GetSelectedComponent());
    RunOnVolume(options, otsu, "Otsu's threshold", ProgressStyle::None);
    filter->SetIsoValue(otsu->GetThreshold());
    announcer.Say("iso-value " + NumberText(filter->GetIsoValue()) +
      " by Otsu's threshold; choose another one with --iso");
  }
  if (!options.HasProperty("SnapshotInterval") && !options.Snapshots.empty())
  {
    filter->SetSnapshotInterval(10);
  }

  CatchInterrupts();
  filter->LeaveCheckpoints(); // Until all is written.
  const FilterRun pyramidRun = GiveLevels(options, volume, pyramid, filter, announcer.Style);
  vtkNew<ResumeTeller> teller;
  teller->Says = &announcer;
  filter->AddObserver(vtkCommand::ProgressEvent, teller);
  const FilterRun run = RunOnVolume(options, filter, "Evolving the surface", announcer.Style);
  teller->Tell(filter);
  for (const FilterRun& each : { pyramidRun, run })
  {
    for (const std::string& warning : each.Warnings)
    {
      announcer.Say("warning: " + warning);
    }
  }

  vtkPolyData* surface = filter->GetOutput();
  const std::string reason = StopReason(surface);
  if (surface->GetNumberOfPolys() == 0)
  {
    RemoveCheckpointOfEnded(filter, reason);
    if (reason == "time limit")
    {
      throw Failure("the time limit came before there was a surface; nothing is written");
    }
    throw Failure(run.IsInterrupted ? "interrupted before there was a surface; nothing is written"
                                    : "the surface vanished: is the object where the image is " +
          std::string(filter->GetObjectIsBright() ? "above " : "below ") +
          NumberText(filter->GetIsoValue()) + "? (--iso, --dark)");
  }
  filter->SetSelectedComponent(component); // as it was chosen
  ReportInput results;
  results.ReaderMemory = readerMemory;
  results.VolumeName = std::filesystem::path(options.Volume).filename().string();
  results.Volume = volume;
  results.Filters = { pyramid, filter };
  results.IsFinished = reason == "converged" || reason == "limit cycle";
  results.PyramidSeconds = pyramidRun.Seconds;
  results.SurfaceSeconds = run.Seconds;
  results.Warnings = run.Warnings;
  WriteOutputs(options, results, announcer.Style);
  RemoveCheckpointOfEnded(filter, reason);

  announcer.Say(std::to_string(surface->GetNumberOfPoints()) + " vertices after " +
    std::to_string(filter->GetHistory()->GetNumberOfRows()) + " iterations: " + reason);
  if (!results.IsFinished)
  {
    const bool canGoOn = !filter->GetCheckpointFolder().empty();
    std::cerr << "volumic: unfinished (" << reason << "); the surface as it is was written"
              << (canGoOn ? "; the same command with --resume goes on" : "") << "\n";
  }
  return results.IsFinished ? Success : Unfinished;
}
}

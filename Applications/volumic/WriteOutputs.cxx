// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteOutputs.h"

#include "GltfScene.h"
#include "LoadInputs.h"
#include "OutputFiles.h"
#include "Report.h"
#include "RunFilter.h"
#include "SurfaceFacts.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "ToolOptions.h"
#include "WriteResults.h"

#include <vtkBoundingBox.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDeformableSurface.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

// ---- What is asked for --------------------------------------------------------------------------

using Kind = OutputName::Kind;

/** Whether the surfaces go into one .vtm rather than into a folder. */
bool IsBlocks(const std::string& name)
{
  return fs::path(name).extension() == ".vtm";
}

/** What is written beside the surfaces. */
std::vector<OutputName> OtherOutputs(const ToolOptions& options)
{
  const std::string report = options.Report == "-" ? "" : options.Report;
  std::vector<OutputName> outputs = {
    { options.Levels, IsBlocks(options.Levels) ? Kind::Blocks : Kind::Folder, "level" },
    { options.Snapshots, IsBlocks(options.Snapshots) ? Kind::Blocks : Kind::Folder, "snapshot" },
    { options.WrittenVolume }, { options.History }, { report }
  };
  outputs.erase(std::remove_if(outputs.begin(), outputs.end(),
                  [](const OutputName& output) { return output.Name.empty(); }),
    outputs.end());
  return outputs;
}

Kind FormOf(const std::string& name)
{
  return SuffixOf(name) == ".vtm" || HasPieces(name) ? Kind::Blocks : Kind::File;
}

/** With a dot, of the surfaces of labels in a folder. */
std::string SuffixIn(const ToolOptions& options)
{
  const std::string suffix = options.Format.empty() ? "vtp" : options.Format;
  return suffix[0] == '.' ? suffix : "." + suffix;
}

std::string PathIn(
  const std::string& folder, const LabelSurface& surface, const ToolOptions& options)
{
  return (fs::path(folder) / (surface.FileName + SuffixIn(options))).string();
}
}

void CheckFiles(const ToolOptions& options)
{
  std::vector<OutputName> outputs;
  for (const std::string& name : options.Surfaces)
  {
    const bool isOfLabels = !options.Labels.empty();
    const bool isFolder = isOfLabels && OutputOf(options, name) == LabelOutput::Folder;
    if (!isOfLabels)
    {
      CheckSurfaceName(name);
    }
    outputs.push_back({ name, isFolder ? Kind::Place : FormOf(name), "" });
  }
  const std::vector<OutputName> others = OtherOutputs(options);
  outputs.insert(outputs.end(), others.begin(), others.end());
  if (!options.WrittenVolume.empty())
  {
    CheckVolumeName(options.WrittenVolume);
  }
  CheckOutputs(outputs, InputsOf(options));
  if (MakesSolids(options))
  {
    FindMesher(options.Solids);
  }
}

// ---- Surfaces -----------------------------------------------------------------------------------

namespace
{
/** The last block of the levels may be level -1. */
int LevelOf(vtkPolyData* surface)
{
  return static_cast<int>(surface->GetFieldData()->GetArray("Level")->GetComponent(0, 0));
}

/** @return the triangles of a piece, of which there is to be one for each rank at least */
int PieceSizeOf(const ToolOptions& options, vtkPolyData* surface)
{
  const vtkIdType share = (surface->GetNumberOfPolys() + options.Ranks - 1) / options.Ranks;
  return static_cast<int>(std::clamp<vtkIdType>(share, 1, options.PieceSize));
}

void WriteSeveral(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  ProgressStyle style, int (*numbers)(vtkPolyData*), Failures& failures)
{
  if (!name.empty())
  {
    failures.Try(
      [&]
      {
        IsBlocks(name) ? WriteBlocks(blocks, name, style)
                       : WriteFolder(blocks, name, prefix, style, numbers);
      });
  }
}
}

void WriteOutputs(const ToolOptions& options, ReportInput& results, ProgressStyle style)
{
  vtkDeformableSurface* filter = results.Filters.Surface;
  SolidMaker solids(options.Solids, WasInterrupted);
  const SurfaceWriting writing = { results.IsFinished ? "" : ", UNFINISHED: " + results.StopReason,
    PieceSizeOf(options, results.Surface), style, &solids };
  MarkSpace(results.Surface, results.Volume.World);
  MarkSpace(filter->GetLevels(), results.Volume.World);
  MarkSpace(filter->GetSnapshots(), results.Volume.World);
  Failures failures;
  for (const std::string& name : options.Surfaces)
  {
    failures.Try([&] { WriteSurface(results.Surface, name, writing); });
  }
  results.Filling = solids.Last();
  WriteSeveral(filter->GetLevels(), options.Levels, "level", style, LevelOf, failures);
  WriteSeveral(filter->GetSnapshots(), options.Snapshots, "snapshot", style, nullptr, failures);
  if (!options.History.empty())
  {
    failures.Try([&] { WriteTable(filter->GetHistory(), options.History); });
  }
  if (!options.Report.empty())
  {
    results.LevelSizes = SizesOf(filter->GetLevels());
    failures.Try([&] { WriteText(ReportText(results), options.Report); });
  }
  failures.Throw();
}

std::string TextOfPrint(
  const ToolOptions& options, const std::vector<vtkPolyData*>& surfaces, const WorldSpace& world)
{
  const bool isPrinted = options.Format == "3mf" || options.Format == ".3mf" ||
    std::any_of(options.Surfaces.begin(), options.Surfaces.end(),
      [](const std::string& name) { return SuffixOf(name) == ".3mf"; });
  vtkBoundingBox box;
  double thinnest = std::numeric_limits<double>::infinity();
  for (vtkPolyData* surface : surfaces)
  {
    if (surface->GetNumberOfPoints() > 0)
    {
      box.AddBounds(surface->GetBounds());
      vtkDataArray* walls = surface->GetPointData()->GetArray("Thickness");
      thinnest = walls ? std::min(thinnest, walls->GetRange()[0]) : thinnest;
    }
  }
  if (!isPrinted || !box.IsValid())
  {
    return "";
  }
  const auto text = [](double length)
  {
    char digits[32];
    std::snprintf(digits, sizeof(digits), "%.4g", length);
    return std::string(digits);
  };
  return "the print is " + text(box.GetLength(0)) + " x " + text(box.GetLength(1)) + " x " +
    text(box.GetLength(2)) + " " + (world.Unit.empty() ? "mm" : world.Unit) +
    (std::isfinite(thinnest) ? "; its thinnest wall has " + text(thinnest)
                             : "; --thin-parts measures its walls");
}

// ---- Labels -------------------------------------------------------------------------------------

namespace
{
std::string UnfinishedRemark(const LabelSurface& surface)
{
  return surface.IsUnfinished() ? ", UNFINISHED: " + StopReason(surface.Surface) : "";
}

SurfaceWriting WritingOf(
  const ToolOptions& options, const LabelSurface& surface, SolidMaker& solids, ProgressStyle style)
{
  return { UnfinishedRemark(surface) + ", " + surface.Name, PieceSizeOf(options, surface.Surface),
    style, &solids };
}

/** All in one file. */
void WriteTogether(
  const std::vector<LabelSurface>& surfaces, const std::string& name, ProgressStyle style)
{
  if (IsScene(name))
  {
    std::vector<SceneObject> objects;
    for (const LabelSurface& surface : surfaces)
    {
      objects.push_back({ surface.Name, surface.Surface });
    }
    WriteScene(objects, name, style);
    return;
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (const LabelSurface& surface : surfaces)
  {
    const unsigned int block = blocks->GetNumberOfBlocks();
    blocks->SetBlock(block, surface.Surface);
    blocks->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), surface.Name.c_str());
  }
  WriteBlocks(blocks, name, style);
}
}

bool LabelSurface::IsUnfinished() const
{
  const std::string reason = StopReason(this->Surface);
  return reason == "cancelled" || reason == "time limit" || reason == "iteration limit";
}

bool MakesSolids(const ToolOptions& options)
{
  return NeedsMesher("x." + options.Format, options.Solids) ||
    std::any_of(options.Surfaces.begin(), options.Surfaces.end(),
      [&options](const std::string& name) { return NeedsMesher(name, options.Solids); });
}

bool SharesInterfaces(const ToolOptions& options)
{
  const bool isMerged = options.HasProperty("Merge"); // to one surface, which is a file of its own
  return options.HasProperty("SharedInterfaces") ||
    (!isMerged && std::any_of(options.Surfaces.begin(), options.Surfaces.end(), IsOfSolids));
}

LabelOutput OutputOf(const ToolOptions& options, const std::string& name)
{
  std::error_code failed;
  const bool isFolder =
    EndsWith(name, "/") || SuffixOf(name).empty() || fs::is_directory(name, failed);
  const std::string suffix = SuffixOf(name);
  const bool isOfAll = SharesInterfaces(options) &&
    (suffix == ".vtp" || suffix == ".vtk" || (IsOfSolids(name) && !options.HasProperty("Merge")));
  return isFolder                       ? LabelOutput::Folder
    : suffix == ".vtm" || IsScene(name) ? LabelOutput::Blocks
    : isOfAll                           ? LabelOutput::Interfaces
                                        : LabelOutput::File;
}

void CheckLabelOutput(const ToolOptions& options, const std::string& name)
{
  FailIf<UsageError>(name == "-", "surfaces of labels are not written to the standard output");
  if (OutputOf(options, name) == LabelOutput::Folder)
  {
    FailIf<UsageError>(options.HasProperty("Merge"),
      name + ": --merge makes one surface: give it a file, not a folder");
    CheckSurfaceName("labels" + SuffixIn(options));
    FailIf<UsageError>(HasPieces(SuffixIn(options)) || SuffixIn(options) == ".pvtp",
      "--format: surfaces in a folder are not written in pieces");
  }
  else if (OutputOf(options, name) == LabelOutput::File)
  {
    try
    {
      CheckSurfaceName(name);
    }
    catch (const UsageError& error)
    {
      throw UsageError(std::string(error.what()) + ", .vtm; a folder is " + name + "/");
    }
  }
}

MadeFolders::~MadeFolders()
{
  std::error_code failed;
  for (auto name = this->Names.rbegin(); name != this->Names.rend(); ++name)
  {
    fs::remove(*name, failed); // only if it is empty
  }
}

void MadeFolders::Make(const std::string& name)
{
  fs::path folder = fs::path(name);
  folder = folder.has_filename() ? folder : folder.parent_path();
  if (folder.empty() || fs::is_directory(folder))
  {
    return;
  }
  this->Make(folder.parent_path().string());
  std::error_code failed;
  fs::create_directory(folder, failed);
  FailIf(static_cast<bool>(failed), name + ": cannot be written: " + failed.message());
  this->Names.push_back(folder.string());
}

void CheckLabelSurfaces(
  const ToolOptions& options, const std::vector<LabelSurface>& surfaces, MadeFolders& folders)
{
  FailIf(SharesInterfaces(options) &&
      std::any_of(surfaces.begin(), surfaces.end(),
        [&](const LabelSurface& surface)
        { return surface.Labels.front().Layer != surfaces.front().Labels.front().Layer; }),
    "--shared-interfaces: the labels lie in several layers of the file, of which those of one can "
    "share interfaces; choose it with --component");
  const std::vector<std::string> inputs = InputsOf(options);
  std::vector<OutputName> outputs = OtherOutputs(options);
  for (const std::string& name : options.Surfaces)
  {
    if (OutputOf(options, name) != LabelOutput::Folder)
    {
      outputs.push_back({ name, FormOf(name), "" });
    }
    if (OutputOf(options, name) == LabelOutput::File && surfaces.size() > 1)
    {
      const std::string stem = fs::path(name).replace_extension().string();
      throw Failure(name + ": " + std::to_string(surfaces.size()) +
        " labels have as many surfaces: give a folder (" + stem + "/ --format " +
        SuffixOf(name).substr(1) + ") or blocks (" + stem + ".vtm, " + stem + ".glb, " + stem +
        ".3mf), or make one of them with --merge, or one mesh of all with --shared-interfaces (" +
        stem + ".vtp, .vtk, .vtu, .inp, .msh, .smesh, .poly)");
    }
  }
  for (const std::string& name : options.Surfaces)
  {
    if (OutputOf(options, name) != LabelOutput::Folder)
    {
      continue;
    }
    folders.Make(name);
    for (const LabelSurface& surface : surfaces)
    {
      // Their names differ from each other.
      outputs.push_back({ PathIn(name, surface, options), OutputName::Kind::File, "" });
      CheckOutputs(outputs, inputs);
      outputs.pop_back();
    }
  }
}

void WriteLabelSurfaces(const ToolOptions& options, std::vector<LabelSurface>& surfaces,
  vtkPolyData* interfaces, SolidMaker& solids, ProgressStyle style, Failures& failures)
{
  for (const std::string& name : options.Surfaces)
  {
    if (OutputOf(options, name) == LabelOutput::Blocks)
    {
      failures.Try([&] { WriteTogether(surfaces, name, style); });
      continue;
    }
    if (OutputOf(options, name) == LabelOutput::Interfaces)
    {
      // All are made at once, and so as finished as the first.
      const SurfaceWriting writing = { UnfinishedRemark(surfaces.front()),
        PieceSizeOf(options, interfaces), style, &solids };
      failures.Try([&] { WriteSurface(interfaces, name, writing); });
      continue;
    }
    // Of many files in a folder not each has a line of its own.
    const bool isFolder = OutputOf(options, name) == LabelOutput::Folder;
    ProgressLine line("Writing", isFolder ? style : ProgressStyle::None);
    double done = 0.0;
    for (LabelSurface& surface : surfaces)
    {
      const std::string path = isFolder ? PathIn(name, surface, options) : name;
      line.Show(done++ / static_cast<double>(surfaces.size()), path);
      if (surface.Surface->GetNumberOfPoints() > 0)
      {
        failures.Try(
          [&]
          {
            WriteSurface(surface.Surface, path,
              WritingOf(options, surface, solids, isFolder ? ProgressStyle::None : style));
            surface.Files.push_back(path);
          });
      }
    }
  }
}
}

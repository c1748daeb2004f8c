// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteResults.h"

#include "GltfScene.h"
#include "OutputFiles.h"
#include "SurfaceFormats.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkDelimitedTextWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

const char* const OfMemory = "cannot be written (not enough memory)";

std::string TitleOf(const std::string& name)
{
  return "Writing " + fs::path(name).filename().string();
}

/**
 * Do some of the work on a file. @throws Failure that names the file
 * @param path beside it, whose folder is of no interest to the user; may be empty
 */
template <class Work>
void WorkOn(const std::string& name, const std::string& path, const Work& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    std::string reason = ReasonOf(error, OfMemory);
    const std::string beside = fs::path(path).parent_path().string() + "/";
    for (std::size_t at = reason.find(beside); !path.empty() && at != std::string::npos;
         at = reason.find(beside))
    {
      reason.erase(at, beside.size());
    }
    throw Failure(name + ": " + reason);
  }
}

/** Have `write` write to a path beside the file, which takes the file's place if all went well. */
template <class Write>
void WriteBeside(const std::string& name, ProgressStyle style, const Write& write)
{
  std::string path;
  WorkOn(name, path,
    [&]
    {
      OutputFile file(name);
      path = file.Path();
      ProgressLine line(TitleOf(name), style);
      write(path, line);
      file.Publish();
    });
}
}

void CheckSurfaceName(const std::string& name)
{
  FailIf<UsageError>(!FindSurfaceFormat(name),
    name +
      ": no surface format has this suffix; known are .vtp .pvtp .vtk .stl .ply "
      ".obj .glb .iv .g .geo .facet .tri .msh .smesh .poly");
}

bool IsScene(const std::string& name)
{
  return SuffixOf(name) == ".glb";
}

bool IsOfSolids(const std::string& name)
{
  const std::string suffix = SuffixOf(name);
  return suffix == ".msh" || suffix == ".smesh" || suffix == ".poly";
}

bool HasPieces(const std::string& name)
{
  return SuffixOf(name) == ".pvtp";
}

void WriteSurface(vtkPolyData* surface, const std::string& name, const SurfaceWriting& writing)
{
  const SurfaceFormat* format = FindSurfaceFormat(name);
  WriteBeside(name, writing.Style,
    [&](const std::string& path, ProgressLine& line)
    {
      const SurfaceFile file{ surface, path, writing.Remark, writing.PieceSize, line };
      format->Write(file);
      if (format->Check)
      {
        format->Check(file);
      }
    });
}

void CheckVolumeName(const std::string& name)
{
  FailIf<UsageError>(SuffixOf(name) != ".vti", name + ": a volume is written as .vti");
}

void WriteVolume(vtkImageData* volume, const std::string& name, ProgressStyle style)
{
  WriteBeside(name, style,
    [&](const std::string& path, ProgressLine& line) { WriteVti(volume, path, line); });
}

void WriteScene(
  const std::vector<SceneObject>& objects, const std::string& name, ProgressStyle style)
{
  WriteBeside(name, style,
    [&](const std::string& path, ProgressLine& line) { WriteGlb(objects, path, line); });
}

void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name, ProgressStyle style)
{
  WriteBeside(name, style,
    [&](const std::string& path, ProgressLine& line) { WriteVtm(blocks, path, line); });
}

void WriteFolder(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  ProgressStyle style, int (*numbers)(vtkPolyData*))
{
  std::error_code failed;
  const bool isNew = fs::create_directories(name, failed);
  try
  {
    StagedFiles files(name);
    for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
    {
      auto* surface = vtkPolyData::SafeDownCast(blocks->GetBlock(i));
      if (surface && surface->GetNumberOfPoints() > 0)
      {
        const std::string number = std::to_string(numbers ? numbers(surface) : static_cast<int>(i));
        const std::string file = prefix + "-" + number + ".vtp";
        const std::string path = files.Folder() + "/" + file;
        ProgressLine line(TitleOf(file), style);
        WriteVtp(surface, path, line);
      }
    }
    files.Publish();
  }
  catch (const std::exception& error)
  {
    if (isNew)
    {
      fs::remove(name, failed); // only if it is empty
    }
    throw Failure(name + ": " + ReasonOf(error, OfMemory));
  }
}

void WriteTable(vtkTable* table, const std::string& name)
{
  WriteBeside(name, ProgressStyle::None,
    [&](const std::string& path, ProgressLine& line)
    {
      vtkNew<vtkDelimitedTextWriter> writer;
      writer->SetInputData(table);
      writer->SetFileName(path.c_str());
      writer->SetFieldDelimiter(",");
      RunWriter(writer.Get(), line);
      CheckLines(path, 1 + static_cast<std::uint64_t>(table->GetNumberOfRows()));
    });
}

void WriteText(const std::string& text, const std::string& name)
{
  if (name == "-")
  {
    std::cout << text;
    return;
  }
  WriteBeside(name, ProgressStyle::None,
    [&](const std::string& path, ProgressLine&) { WriteBytes(path, text.data(), text.size()); });
}
}

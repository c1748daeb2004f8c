// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteResults.h"

#include "GltfScene.h"
#include "Messages.h"
#include "OutputFiles.h"
#include "SurfaceFormats.h"
#include "Tetrahedra.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"
#include "WorldSpace.h"

#include <vtkBoundingBox.h>
#include <vtkDelimitedTextWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <set>

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

namespace
{
/** Tells where a format, whose coordinates are float, rounds them too much for the triangles. */
void TellOfRounding(vtkPolyData* surface, const std::string& name)
{
  static const std::set<std::string> exact = { ".vtp", ".pvtp", ".vtk" };
  if (exact.count(SuffixOf(name)) > 0 || IsOfSolids(name) || surface->GetNumberOfPolys() == 0)
  {
    return;
  }
  const vtkBoundingBox box(surface->GetBounds());
  // About the edges of as many triangles on the faces of the surface's box.
  const double edge =
    2.0 * box.GetDiagonalLength() / std::sqrt(static_cast<double>(surface->GetNumberOfPolys()));
  const double* bounds = surface->GetBounds();
  const double largest = std::max(std::abs(*std::min_element(bounds, bounds + 6)),
    std::abs(*std::max_element(bounds, bounds + 6)));
  const double step = largest * std::numeric_limits<float>::epsilon();
  if (step > 0.01 * edge)
  {
    TellOfFile(name + ": coordinates up to " + NumberText(std::round(largest)) +
      " are rounded there by steps of " + NumberText(std::round(1e4 * step) / 1e4) +
      ", edges are about " + NumberText(std::round(1e4 * edge) / 1e4) +
      " long; .vtp, .vtk and .msh keep them");
  }
}
}

void CheckSurfaceName(const std::string& name)
{
  FailIf<UsageError>(!FindSurfaceWriter(name),
    name +
      ": no surface format has this suffix; known are .vtp .pvtp .vtk .stl .ply "
      ".obj .glb .3mf .vtu .inp .msh .smesh .poly");
}

bool IsScene(const std::string& name)
{
  return SuffixOf(name) == ".glb" || SuffixOf(name) == ".3mf";
}

bool IsOfSolids(const std::string& name)
{
  const std::string suffix = SuffixOf(name);
  return suffix == ".msh" || suffix == ".smesh" || suffix == ".poly" || suffix == ".vtu" ||
    suffix == ".inp";
}

bool HasPieces(const std::string& name)
{
  return SuffixOf(name) == ".pvtp";
}

void WriteSurface(vtkPolyData* surface, const std::string& name, const SurfaceWriting& writing)
{
  const SurfaceWriter write = FindSurfaceWriter(name);
  TellOfRounding(surface, name);
  WriteBeside(name, writing.Style,
    [&](const std::string& path, ProgressLine& line)
    {
      const std::string remark = "volumic " VOLUMIC_VERSION + SpaceRemark(surface) + writing.Remark;
      SolidMaker solids{ SolidChoice() };
      write({ surface, path, remark, writing.PieceSize, line,
        writing.Solids ? writing.Solids : &solids });
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
  for (const SceneObject& object : objects)
  {
    TellOfRounding(object.Surface, name);
  }
  WriteBeside(name, style,
    [&](const std::string& path, ProgressLine& line) {
      SuffixOf(path) == ".3mf" ? WriteThreeMf(objects, path, line) : WriteGlb(objects, path, line);
    });
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

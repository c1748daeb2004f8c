// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteResults.h"

#include "CheckInputs.h"
#include "CheckWritten.h"
#include "FileGrowth.h"
#include "GltfScene.h"
#include "SurfaceFields.h"
#include "OutputFiles.h"
#include "Ranks.h"
#include "RunWriter.h"
#include "StreamedWriters.h"
#include "SurfacePieces.h"
#include "Texts.h"
#include "ToolErrors.h"

#include <vtkBYUWriter.h>
#include <vtkDelimitedTextWriter.h>
#include <vtkFacetWriter.h>
#include <vtkHoudiniPolyDataWriter.h>
#include <vtkIVWriter.h>
#include <vtkMCubesWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLMultiBlockDataWriter.h>

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <vector>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

/** Why the file cannot be written. */
std::string ReasonOf(const std::exception& error)
{
  const bool isOfMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  return isOfMemory ? "cannot be written (not enough memory)" : error.what();
}

std::string TitleOf(const std::string& name)
{
  return "Writing " + fs::path(name).filename().string();
}

/** @param beside the folder, which is of no interest to the user */
[[noreturn]] void ThrowWithout(
  const std::string& beside, const std::string& name, const std::exception& error)
{
  std::string reason = ReasonOf(error);
  for (std::size_t at = reason.find(beside); !beside.empty() && at != std::string::npos;
       at = reason.find(beside))
  {
    reason.erase(at, beside.size());
  }
  throw Failure(name + ": " + reason);
}

std::string FolderAbout(const std::string& path)
{
  return fs::path(path).parent_path().string() + "/";
}

/** Have `write` write to a path beside the file, which takes the file's place if all went well. */
template <class Write>
void WriteBeside(const std::string& name, const Write& write)
{
  std::string beside;
  try
  {
    OutputFile file(name);
    beside = FolderAbout(file.Path());
    write(file.Path());
    file.Publish();
  }
  catch (const std::exception& error)
  {
    ThrowWithout(beside, name, error);
  }
}

/** A surface, and all that is told to a writer of it. */
struct SurfaceFile
{
  vtkPolyData* Surface;
  std::string Path;
  std::string Remark;
  int PieceSize;
  ProgressLine& Line;
};

template <class Writer>
void WriteWith(const SurfaceFile& file)
{
  vtkNew<Writer> writer;
  writer->SetInputData(file.Surface);
  writer->SetFileName(file.Path.c_str());
  RunWriter(writer.Get(), file.Line);
}

/** Of a binary file that has so many bytes for each point and triangle, about. */
std::uint64_t BytesOf(vtkPolyData* surface, int point, int triangle)
{
  return static_cast<std::uint64_t>(
    point * surface->GetNumberOfPoints() + triangle * surface->GetNumberOfPolys());
}

void WriteStl(const SurfaceFile& file)
{
  const FileGrowth growth(file.Path, BytesOf(file.Surface, 0, 50), file.Line);
  vtkNew<vtkSTLWriter> writer;
  writer->SetInputData(file.Surface);
  writer->SetFileName(file.Path.c_str());
  writer->SetFileTypeToBinary();
  // The head of a binary file has 80 bytes.
  vtkNew<vtkUnsignedCharArray> head;
  for (std::size_t i = 0; i < 80; ++i)
  {
    head->InsertNextValue(
      i < file.Remark.size() ? static_cast<unsigned char>(file.Remark[i]) : ' ');
  }
  writer->SetBinaryHeader(head);
  RunWriter(writer.Get(), file.Line);
}

/** With the colour of its label at each vertex, if there are labels. */
void WritePly(const SurfaceFile& file)
{
  const FileGrowth growth(file.Path, BytesOf(file.Surface, 12, 13), file.Line);
  vtkNew<vtkPLYWriter> writer;
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(file.Surface);
  if (const auto colors = VertexColors(file.Surface))
  {
    surface->GetPointData()->AddArray(colors);
    writer->SetArrayName(colors->GetName());
  }
  writer->SetInputData(surface);
  writer->SetFileName(file.Path.c_str());
  writer->AddComment(file.Remark);
  RunWriter(writer.Get(), file.Line);
}

/**
 * What a text of the surface takes at most: numbers of six digits, and each point with a colour.
 */
std::size_t LargestText(vtkPolyData* surface)
{
  return 1024 +
    static_cast<std::size_t>(100 * surface->GetNumberOfPoints() + 64 * surface->GetNumberOfPolys());
}

/** On a full disk the writer of VTK 9.6 destroys memory instead of telling. */
void WriteInventor(const SurfaceFile& file)
{
  NeedRoom(file.Path, LargestText(file.Surface));
  WriteWith<vtkIVWriter>(file);
}

/** As WriteInventor. */
void WriteByu(const SurfaceFile& file)
{
  NeedRoom(file.Path, LargestText(file.Surface));
  vtkNew<vtkBYUWriter> writer;
  writer->SetInputData(file.Surface);
  writer->SetGeometryFileName(file.Path.c_str());
  RunWriter(writer.Get(), file.Line);
}

/** VTK's writer counts what it has written on the standard output, where a report may go. */
void WriteFacet(const SurfaceFile& file)
{
  std::streambuf* output = std::cout.rdbuf(nullptr);
  try
  {
    WriteWith<vtkFacetWriter>(file);
  }
  catch (...)
  {
    std::cout.rdbuf(output);
    throw;
  }
  std::cout.rdbuf(output); // clears the errors too
}

/** A file of fixed size: a head, and the triangles. */
template <int Head, int Triangle>
void CheckTriangles(const std::string& path, vtkPolyData* surface)
{
  CheckSize(path, Head + static_cast<std::uint64_t>(Triangle) * surface->GetNumberOfPolys());
}

/** A text of a line for each point and triangle, and some more. */
template <int More>
void CheckText(const std::string& path, vtkPolyData* surface)
{
  CheckLines(path,
    More + static_cast<std::uint64_t>(surface->GetNumberOfPoints() + surface->GetNumberOfPolys()));
}

void CheckObj(const std::string& path, vtkPolyData* surface)
{
  const vtkIdType normals =
    surface->GetPointData()->GetNormals() ? surface->GetNumberOfPoints() : 0;
  CheckLines(path,
    static_cast<std::uint64_t>(
      1 + surface->GetNumberOfPoints() + normals + surface->GetNumberOfPolys()));
}

/** A text with two points in a line. */
template <int More>
void CheckPairs(const std::string& path, vtkPolyData* surface)
{
  CheckLines(path,
    More +
      static_cast<std::uint64_t>(
        (surface->GetNumberOfPoints() + 1) / 2 + surface->GetNumberOfPolys()));
}

void WriteVtpFile(const SurfaceFile& file)
{
  WriteVtp(file.Surface, file.Path, file.Line);
}

void WriteLegacyFile(const SurfaceFile& file)
{
  WriteLegacy(file.Surface, file.Path, file.Line);
}

void WriteGlbFile(const SurfaceFile& file)
{
  const std::vector<SurfaceLabel> labels = LabelsOf(file.Surface);
  const std::string name = labels.size() == 1 ? labels.front().Name : "surface";
  WriteGlb({ { name, file.Surface } }, file.Path, file.Line);
}

void WritePiecesFile(const SurfaceFile& file)
{
  WritePieces(file.Surface, file.Path, file.PieceSize, file.Line);
}

void CheckVtp(const std::string& path, vtkPolyData*)
{
  CheckXml(path);
}

void CheckWrittenPly(const std::string& path, vtkPolyData*)
{
  try
  {
    CheckPly(path);
  }
  catch (const Failure&)
  {
    throw Failure("cannot be written (not all of it was; is the disk full?)");
  }
}

struct Format
{
  void (*Write)(const SurfaceFile&);
  /** Whether the disk took it all; none where that was seen at once. */
  void (*Check)(const std::string& path, vtkPolyData*);
};

const Format* FindFormat(const std::string& name)
{
  static const std::map<std::string, Format> formats = {
    { ".vtp", { WriteVtpFile, CheckVtp } },
    { ".pvtp", { WritePiecesFile, CheckVtp } },
    { ".vtk", { WriteLegacyFile, nullptr } },
    { ".stl", { WriteStl, CheckTriangles<84, 50> } },
    { ".ply", { WritePly, CheckWrittenPly } },
    { ".glb", { WriteGlbFile, nullptr } },
    { ".obj", { WriteWith<vtkOBJWriter>, CheckObj } },
    { ".iv", { WriteInventor, CheckPairs<14> } },
    { ".g", { WriteByu, CheckPairs<2> } },
    { ".geo", { WriteWith<vtkHoudiniPolyDataWriter>, CheckText<7> } },
    { ".facet", { WriteFacet, CheckText<8> } },
    { ".tri", { WriteWith<vtkMCubesWriter>, CheckTriangles<0, 72> } },
  };
  const auto found = formats.find(SuffixOf(name));
  return found == formats.end() ? nullptr : &found->second;
}
}

void CheckSurfaceName(const std::string& name)
{
  if (!FindFormat(name))
  {
    throw UsageError(name +
      ": no surface format has this suffix; known are .vtp .pvtp .vtk .stl .ply "
      ".obj .glb .iv .g .geo .facet .tri");
  }
}

bool IsScene(const std::string& name)
{
  return SuffixOf(name) == ".glb";
}

bool HasPieces(const std::string& name)
{
  return SuffixOf(name) == ".pvtp";
}

void WriteSurface(vtkPolyData* surface, const std::string& name, const SurfaceWriting& writing)
{
  const Format* format = FindFormat(name);
  WriteBeside(name,
    [&](const std::string& path)
    {
      ProgressLine line(TitleOf(name), writing.Style);
      format->Write({ surface, path, writing.Remark, writing.PieceSize, line });
      if (format->Check)
      {
        format->Check(path, surface);
      }
    });
}

void WriteSurfaceOfRanks(
  vtkPolyData* part, const std::string& name, const SurfaceWriting& writing, Ranks& ranks)
{
  std::unique_ptr<OutputFile> file; // of the first rank
  std::string path;
  const auto together = [&](const std::function<void()>& work)
  {
    ranks.Together(
      [&]
      {
        try
        {
          work();
        }
        catch (const std::exception& error)
        {
          ThrowWithout(path.empty() ? path : FolderAbout(path), name, error);
        }
      });
  };
  together(
    [&]
    {
      if (ranks.IsFirst())
      {
        file = std::make_unique<OutputFile>(name);
        path = file->Path();
        fs::create_directory(fs::path(path).replace_extension());
      }
    });
  path = ranks.Broadcast(std::move(path));
  const int own = NumberOfPieces(part, writing.PieceSize);
  int first = 0;
  int all = 0;
  const std::vector<std::string> numbers = ranks.GatherOnAll(std::to_string(own));
  for (int rank = 0; rank < ranks.Count(); ++rank)
  {
    const int number = std::atoi(numbers[static_cast<std::size_t>(rank)].c_str());
    first += rank < ranks.Rank() ? number : 0;
    all += number;
  }
  std::string arrays;
  together(
    [&]
    {
      ProgressLine line(TitleOf(name), writing.Style);
      arrays = WritePieceFiles(part, path, writing.PieceSize, first, line);
    });
  for (const std::string& told : ranks.GatherOnAll(arrays))
  {
    arrays = arrays.empty() ? told : arrays;
  }
  together(
    [&]
    {
      if (file)
      {
        WritePieceList(path, arrays, all);
        CheckXml(path);
        file->Publish();
      }
    });
}

void CheckVolumeName(const std::string& name)
{
  if (SuffixOf(name) != ".vti")
  {
    throw UsageError(name + ": a volume is written as .vti");
  }
}

void WriteVolume(vtkImageData* volume, const std::string& name, ProgressStyle style)
{
  WriteBeside(name,
    [&](const std::string& path)
    {
      ProgressLine line(TitleOf(name), style);
      WriteVti(volume, path, line);
      CheckXml(path);
    });
}

void WriteScene(
  const std::vector<SceneObject>& objects, const std::string& name, ProgressStyle style)
{
  WriteBeside(name,
    [&](const std::string& path)
    {
      ProgressLine line(TitleOf(name), style);
      WriteGlb(objects, path, line);
    });
}

void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name, ProgressStyle style)
{
  vtkNew<vtkMultiBlockDataSet> triangles;
  triangles->ShallowCopy(blocks);
  for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
  {
    if (auto* surface = vtkPolyData::SafeDownCast(blocks->GetBlock(i)))
    {
      triangles->SetBlock(i, AsTriangles(surface));
    }
  }
  WriteBeside(name,
    [&](const std::string& path)
    {
      ProgressLine line(TitleOf(name), style);
      vtkNew<vtkXMLMultiBlockDataWriter> writer;
      writer->SetInputData(triangles);
      writer->SetFileName(path.c_str());
      RunWriter(writer.Get(), line);
      CheckXml(path);
      CheckXml(fs::path(path).replace_extension().string());
    });
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
        CheckXml(path);
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
    throw Failure(name + ": " + ReasonOf(error));
  }
}

void WriteTable(vtkTable* table, const std::string& name)
{
  WriteBeside(name,
    [&](const std::string& path)
    {
      vtkNew<vtkDelimitedTextWriter> writer;
      writer->SetInputData(table);
      writer->SetFileName(path.c_str());
      writer->SetFieldDelimiter(",");
      ProgressLine noLine("", ProgressStyle::None);
      RunWriter(writer.Get(), noLine);
      CheckLines(path, 1 + static_cast<std::uint64_t>(table->GetNumberOfRows()));
    });
}

void WriteText(const std::string& text, const std::string& name)
{
  WriteBeside(name, [&](const std::string& path) { WriteBytes(path, text.data(), text.size()); });
}
}

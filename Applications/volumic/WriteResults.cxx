// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteResults.h"

#include "CheckInputs.h"
#include "CheckWritten.h"
#include "OutputFiles.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkMessages.h"

#include <vtkBYUWriter.h>
#include <vtkDelimitedTextWriter.h>
#include <vtkFacetWriter.h>
#include <vtkHoudiniPolyDataWriter.h>
#include <vtkIVWriter.h>
#include <vtkImageData.h>
#include <vtkMCubesWriter.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWriter.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLWriter.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

/** Run a writer whose input and file are set. */
template <class Writer>
void Run(Writer* writer)
{
  VtkMessages messages;
  messages.ListenTo(writer);
  messages.Catch([&] { writer->Write(); });
  if (!messages.Errors.empty() || writer->GetErrorCode() != 0)
  {
    const std::string reason = messages.JoinedErrors();
    throw Failure("cannot be written (" + (reason.empty() ? "is the disk full?" : reason) + ")");
  }
}

/** Why the file cannot be written. */
std::string ReasonOf(const std::exception& error)
{
  const bool isOfMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  return isOfMemory ? "cannot be written (not enough memory)" : error.what();
}

/** Have `write` write to a path beside the file, which takes the file's place if all went well. */
template <class Write>
void WriteBeside(const std::string& name, const Write& write)
{
  std::string beside;
  try
  {
    OutputFile file(name);
    beside = fs::path(file.Path()).parent_path().string() + "/";
    write(file.Path());
    file.Publish();
  }
  catch (const std::exception& error)
  {
    std::string reason = ReasonOf(error);
    for (std::size_t at = reason.find(beside); !beside.empty() && at != std::string::npos;
         at = reason.find(beside))
    {
      reason.erase(at, beside.size()); // the place is of no interest to the user
    }
    throw Failure(name + ": " + reason);
  }
}

template <class Writer>
void WriteWith(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<Writer> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  Run(writer.Get());
}

/**
 * With the data inline: ParaView 5.11's readers, with an expat of 2024 or later, take what is
 * appended for damaged. By way of a string, as VTK's writer ends the program on a full disk then.
 */
void WriteInline(vtkXMLWriter* writer, vtkDataObject* data, const std::string& name)
{
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->WriteToOutputStringOn();
  Run(writer);
  const std::string text = writer->GetOutputString();
  WriteBytes(name, text.data(), text.size());
}

void WriteVtp(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  WriteInline(writer, surface, name);
}

void WriteLegacy(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<vtkPolyDataWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileTypeToBinary();
  writer->WriteToOutputStringOn();
  Run(writer.Get());
  WriteBytes(
    name, writer->GetOutputString(), static_cast<std::size_t>(writer->GetOutputStringLength()));
}

void WriteStl(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  vtkNew<vtkSTLWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  writer->SetFileTypeToBinary();
  // The head of a binary file has 80 bytes.
  vtkNew<vtkUnsignedCharArray> head;
  for (std::size_t i = 0; i < 80; ++i)
  {
    head->InsertNextValue(i < remark.size() ? static_cast<unsigned char>(remark[i]) : ' ');
  }
  writer->SetBinaryHeader(head);
  Run(writer.Get());
}

void WritePly(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  writer->AddComment(remark);
  Run(writer.Get());
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
void WriteInventor(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  NeedRoom(name, LargestText(surface));
  WriteWith<vtkIVWriter>(surface, name, remark);
}

/** As WriteInventor. */
void WriteByu(vtkPolyData* surface, const std::string& name, const std::string&)
{
  NeedRoom(name, LargestText(surface));
  vtkNew<vtkBYUWriter> writer;
  writer->SetInputData(surface);
  writer->SetGeometryFileName(name.c_str());
  Run(writer.Get());
}

/** VTK's writer counts what it has written on the standard output, where a report may go. */
void WriteFacet(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  std::streambuf* output = std::cout.rdbuf(nullptr);
  try
  {
    WriteWith<vtkFacetWriter>(surface, name, remark);
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
  void (*Write)(vtkPolyData*, const std::string& path, const std::string& remark);
  /** Whether the disk took it all; none where that was seen at once. */
  void (*Check)(const std::string& path, vtkPolyData*);
};

const Format* FindFormat(const std::string& name)
{
  static const std::map<std::string, Format> formats = {
    { ".vtp", { WriteVtp, CheckVtp } },
    { ".vtk", { WriteLegacy, nullptr } },
    { ".stl", { WriteStl, CheckTriangles<84, 50> } },
    { ".ply", { WritePly, CheckWrittenPly } },
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
      ": no surface format has this suffix; known are .vtp .vtk .stl .ply "
      ".obj .iv .g .geo .facet .tri");
  }
}

void WriteSurface(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  const Format* format = FindFormat(name);
  WriteBeside(name,
    [&](const std::string& path)
    {
      format->Write(surface, path, remark);
      if (format->Check)
      {
        format->Check(path, surface);
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

void WriteVolume(vtkImageData* volume, const std::string& name)
{
  WriteBeside(name,
    [&](const std::string& path)
    {
      vtkNew<vtkXMLImageDataWriter> writer;
      writer->SetCompressorTypeToLZ4(); // four times as fast as zlib, at 1.5 times the size (a CT)
      WriteInline(writer, volume, path);
      CheckXml(path);
    });
}

void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name)
{
  WriteBeside(name,
    [&](const std::string& path)
    {
      vtkNew<vtkXMLMultiBlockDataWriter> writer;
      writer->SetInputData(blocks);
      writer->SetFileName(path.c_str());
      Run(writer.Get());
      CheckXml(path);
      CheckXml(fs::path(path).replace_extension().string());
    });
}

void WriteFolder(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  int (*numbers)(vtkPolyData*))
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
        const std::string path = files.Folder() + "/" + prefix + "-" + number + ".vtp";
        WriteVtp(surface, path, "");
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
      Run(writer.Get());
      CheckLines(path, 1 + static_cast<std::uint64_t>(table->GetNumberOfRows()));
    });
}

void WriteText(const std::string& text, const std::string& name)
{
  WriteBeside(name, [&](const std::string& path) { WriteBytes(path, text.data(), text.size()); });
}
}

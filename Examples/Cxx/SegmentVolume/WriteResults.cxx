// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "WriteResults.h"

#include "ToolErrors.h"
#include "VtkMessages.h"

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
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWriter.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <map>

namespace tool
{
namespace
{
namespace fs = std::filesystem;

/// Run a writer whose input and file are set.
template <class Writer>
void Run(Writer* writer, const std::string& name)
{
  VtkMessages messages;
  messages.ListenTo(writer);
  writer->Write();
  std::error_code none;
  if (!messages.Errors.empty() || writer->GetErrorCode() != 0 || fs::file_size(name, none) == 0 ||
    none)
  {
    const std::string reason = messages.JoinedErrors();
    throw Failure(name + ": cannot be written" + (reason.empty() ? "" : " (" + reason + ")"));
  }
}

template <class Writer>
void WriteWith(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<Writer> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  Run(writer.Get(), name);
}

void WriteLegacy(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<vtkPolyDataWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  writer->SetFileTypeToBinary();
  Run(writer.Get(), name);
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
  Run(writer.Get(), name);
}

void WritePly(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  writer->AddComment(remark);
  Run(writer.Get(), name);
}

void WriteByu(vtkPolyData* surface, const std::string& name, const std::string&)
{
  vtkNew<vtkBYUWriter> writer;
  writer->SetInputData(surface);
  writer->SetGeometryFileName(name.c_str());
  Run(writer.Get(), name);
}

/// VTK's writer counts what it has written on the standard output, where a report may go.
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

using Writer = void (*)(vtkPolyData*, const std::string& name, const std::string& remark);

Writer FindWriter(const std::string& name)
{
  static const std::map<std::string, Writer> writers = {
    { ".vtp", WriteWith<vtkXMLPolyDataWriter> },
    { ".vtk", WriteLegacy },
    { ".stl", WriteStl },
    { ".ply", WritePly },
    { ".obj", WriteWith<vtkOBJWriter> },
    { ".iv", WriteWith<vtkIVWriter> },
    { ".g", WriteByu },
    { ".geo", WriteWith<vtkHoudiniPolyDataWriter> },
    { ".facet", WriteFacet },
    { ".tri", WriteWith<vtkMCubesWriter> },
  };
  std::string suffix = fs::path(name).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = writers.find(suffix);
  return found == writers.end() ? nullptr : found->second;
}
}

void CheckFolderOf(const std::string& name)
{
  const fs::path folder = fs::path(name).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
  {
    throw Failure(name + ": there is no folder " + folder.string());
  }
}

void CheckSurfaceName(const std::string& name)
{
  if (!FindWriter(name))
  {
    throw UsageError(name +
      ": no surface format has this suffix; known are .vtp .vtk .stl .ply "
      ".obj .iv .g .geo .facet .tri");
  }
  CheckFolderOf(name);
}

void WriteSurface(vtkPolyData* surface, const std::string& name, const std::string& remark)
{
  FindWriter(name)(surface, name, remark);
}

void WriteBlocks(vtkMultiBlockDataSet* blocks, const std::string& name, const std::string& prefix,
  int (*numbers)(vtkPolyData*))
{
  if (fs::path(name).extension() == ".vtm")
  {
    vtkNew<vtkXMLMultiBlockDataWriter> writer;
    writer->SetInputData(blocks);
    writer->SetFileName(name.c_str());
    Run(writer.Get(), name);
    return;
  }
  std::error_code failed;
  fs::create_directories(name, failed);
  if (failed)
  {
    throw Failure(name + ": " + failed.message());
  }
  for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
  {
    auto* surface = vtkPolyData::SafeDownCast(blocks->GetBlock(i));
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      const std::string number = std::to_string(numbers ? numbers(surface) : static_cast<int>(i));
      const fs::path file = fs::path(name) / (prefix + "-" + number + ".vtp");
      WriteWith<vtkXMLPolyDataWriter>(surface, file.string(), "");
    }
  }
}

void WriteTable(vtkTable* table, const std::string& name)
{
  vtkNew<vtkDelimitedTextWriter> writer;
  writer->SetInputData(table);
  writer->SetFileName(name.c_str());
  writer->SetFieldDelimiter(",");
  Run(writer.Get(), name);
}
}

// SPDX-FileCopyrightText: Copyright (c) Volumic contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFormats.h"

#include "CheckInputs.h"
#include "GltfScene.h"
#include "OutputFiles.h"
#include "SolverFiles.h"
#include "SurfaceFields.h"
#include "SurfacePieces.h"
#include "Texts.h"
#include "ToolErrors.h"
#include "VtkWriters.h"

#include <vtkBYUWriter.h>
#include <vtkFacetWriter.h>
#include <vtkHoudiniPolyDataWriter.h>
#include <vtkIVWriter.h>
#include <vtkMCubesWriter.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkUnsignedCharArray.h>

#include <cstdint>
#include <iostream>
#include <map>
#include <vector>

namespace tool
{
namespace
{
std::uint64_t PointsIn(const SurfaceFile& file)
{
  return static_cast<std::uint64_t>(file.Surface->GetNumberOfPoints());
}

std::uint64_t TrianglesIn(const SurfaceFile& file)
{
  return static_cast<std::uint64_t>(file.Surface->GetNumberOfPolys());
}

template <class Writer>
void WriteWith(const SurfaceFile& file)
{
  vtkNew<Writer> writer;
  writer->SetInputData(file.Surface);
  writer->SetFileName(file.Path.c_str());
  RunWriter(writer.Get(), file.Line);
}

void WriteStl(const SurfaceFile& file)
{
  const FileGrowth growth(file.Path, 50 * TrianglesIn(file), file.Line);
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
  const FileGrowth growth(file.Path, 12 * PointsIn(file) + 13 * TrianglesIn(file), file.Line);
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
 * On a full disk the writers of .iv and .g of VTK 9.6 destroy memory instead of telling. Texts have
 * numbers of six digits, and each point a colour, at most.
 */
void NeedRoomForText(const SurfaceFile& file)
{
  NeedRoom(file.Path, 1024 + 100 * PointsIn(file) + 64 * TrianglesIn(file));
}

void WriteByu(const SurfaceFile& file)
{
  NeedRoomForText(file);
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

void WriteScene(const SurfaceFile& file)
{
  const std::vector<SurfaceLabel> labels = LabelsOf(file.Surface);
  const std::string name = labels.size() == 1 ? labels.front().Name : "surface";
  WriteGlb({ { name, file.Surface } }, file.Path, file.Line);
}

void CheckXmlFile(const SurfaceFile& file)
{
  CheckXml(file.Path);
}

void CheckPlyFile(const SurfaceFile& file)
{
  try
  {
    CheckPly(file.Path);
  }
  catch (const Failure&)
  {
    throw Failure("cannot be written (not all of it was; is the disk full?)");
  }
}

void CheckObjFile(const SurfaceFile& file)
{
  const bool hasNormals = file.Surface->GetPointData()->GetNormals() != nullptr;
  CheckLines(file.Path, 1 + (hasNormals ? 2 : 1) * PointsIn(file) + TrianglesIn(file));
}

/** A file of fixed size: a head, and the triangles. */
template <int Head, int Triangle>
void CheckTriangles(const SurfaceFile& file)
{
  CheckSize(file.Path, Head + Triangle * TrianglesIn(file));
}

/** A text of so many lines, one for so many points, and one for each triangle. */
template <int More, int PointsOfLine>
void CheckText(const SurfaceFile& file)
{
  CheckLines(
    file.Path, More + (PointsIn(file) + PointsOfLine - 1) / PointsOfLine + TrianglesIn(file));
}
}

const SurfaceFormat* FindSurfaceFormat(const std::string& name)
{
  using File = const SurfaceFile&;
  static const std::map<std::string, SurfaceFormat> formats = {
    { ".vtp", { [](File file) { WriteVtp(file.Surface, file.Path, file.Line); }, CheckXmlFile } },
    { ".pvtp",
      { [](File file) { WritePieces(file.Surface, file.Path, file.PieceSize, file.Line); },
        CheckXmlFile } },
    { ".vtk", { [](File file) { WriteLegacy(file.Surface, file.Path, file.Line); }, nullptr } },
    { ".stl", { WriteStl, CheckTriangles<84, 50> } },
    { ".ply", { WritePly, CheckPlyFile } },
    { ".glb", { WriteScene, nullptr } },
    { ".msh",
      { [](File file) { WriteMsh(file.Surface, file.Path, file.Remark, file.Line); }, nullptr } },
    { ".smesh",
      { [](File file) { WriteSmesh(file.Surface, file.Path, file.Remark, file.Line); }, nullptr } },
    { ".poly",
      { [](File file) { WritePoly(file.Surface, file.Path, file.Remark, file.Line); }, nullptr } },
    { ".obj", { WriteWith<vtkOBJWriter>, CheckObjFile } },
    { ".iv",
      { [](File file)
        {
          NeedRoomForText(file);
          WriteWith<vtkIVWriter>(file);
        },
        CheckText<14, 2> } },
    { ".g", { WriteByu, CheckText<2, 2> } },
    { ".geo", { WriteWith<vtkHoudiniPolyDataWriter>, CheckText<7, 1> } },
    { ".facet", { WriteFacet, CheckText<8, 1> } },
    { ".tri", { WriteWith<vtkMCubesWriter>, CheckTriangles<0, 72> } },
  };
  const auto found = formats.find(SuffixOf(name));
  return found == formats.end() ? nullptr : &found->second;
}
}
